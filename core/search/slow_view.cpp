#include "core/search/slow_view.h"

#include <algorithm>
#include <cmath>

#include "core/search/evidence.h"
#include "core/search/peak.h"
#include "core/spectrum/cosine_transform.h"

namespace imunoise {
namespace {

using Index = Eigen::Index;

constexpr Index kMostBlocks = 16384;

// The smallest divisor of n that makes at most kMostBlocks blocks. Lengths are made of small
// primes, so one is near. The blocks of an even number of samples are even in number, too: their
// transform takes half the time.
Index block_length(Index n) {
  Index block = (n + kMostBlocks - 1) / kMostBlocks;
  while (n % block != 0 || n / block % 2 != n % 2) ++block;
  return block;
}

}  // namespace

SlowView::SlowView(const Current& current) : rate_(current.subject().rate) {
  Index total = 0;
  for (std::size_t k = 0; k < current.cosines.size(); ++k) {
    const Index n = current.cosines[k].size() + 1;
    const Index block = block_length(n);
    // Block means show their faster half distorted; where samples are blocks there is no loss.
    const Index kept = block == 1 ? n - 1 : n / block / 2;
    parts_.push_back({block, total, current.spectrum[k].head(kept).sqrt()});
    total += kept;
  }
  left_.resize(total);
  for (std::size_t k = 0; k < parts_.size(); ++k) {
    const Index kept = parts_[k].deviation.size();
    left_.segment(parts_[k].begin, kept) =
        (current.cosines[k].head(kept).array() / parts_[k].deviation).matrix();
  }
}

double SlowView::longest_block_seconds() const {
  double out = 0.0;
  for (std::size_t k = 0; k < parts_.size(); ++k) out = std::max(out, block_seconds(k));
  return out;
}

Eigen::VectorXd SlowView::means(const VectorRef& samples, std::size_t replicate) const {
  const Index length = block(replicate);
  Eigen::VectorXd out(samples.size() / length);
  for (Index i = 0; i < out.size(); ++i) out(i) = samples.segment(i * length, length).mean();
  return out;
}

Eigen::VectorXd SlowView::whitened(const std::vector<Eigen::VectorXd>& means) const {
  Eigen::VectorXd out(left_.size());
  for (std::size_t k = 0; k < parts_.size(); ++k) {
    const Part& part = parts_[k];
    const Index kept = part.deviation.size();
    const double scale = std::sqrt(static_cast<double>(part.block));
    out.segment(part.begin, kept) =
        (scale * cosine_transform(means[k]).head(kept).array() / part.deviation).matrix();
  }
  return out;
}

double SlowView::gain(const Eigen::VectorXd& whitened, bool own) const {
  double out = 0.0;
  double product = 0.0;
  double square = 0.0;
  for (const Part& part : parts_) {
    const Index kept = part.deviation.size();
    const double one = whitened.segment(part.begin, kept).dot(left_.segment(part.begin, kept));
    const double norm = whitened.segment(part.begin, kept).squaredNorm();
    if (norm > 0.0) out += 0.5 * one * one / norm;
    product += one;
    square += norm;
  }
  if (own) return out;
  return square > 0.0 ? 0.5 * product * product / square : 0.0;
}

SlowView::Two SlowView::two(const Eigen::VectorXd& first, const Eigen::VectorXd& second) const {
  const double aa = first.squaredNorm();
  const double bb = second.squaredNorm();
  const double ab = first.dot(second);
  const double determinant = aa * bb - ab * ab;
  constexpr double kAlike = 1e-9;
  if (!(determinant > kAlike * aa * bb)) return {};
  const double a = first.dot(left_);
  const double b = second.dot(left_);
  const double one = (bb * a - ab * b) / determinant;
  const double other = (aa * b - ab * a) / determinant;
  if (other == 0.0) return {};
  const double ratio = one / other;
  const double variance =
      (bb + 2.0 * ratio * ab + ratio * ratio * aa) / (determinant * other * other);
  return {.gain = 0.5 * (one * a + other * b),
          .ratio = ratio,
          .ratio_error = std::sqrt(variance),
          .information = determinant / aa};
}

SlowView::BestTime SlowView::best_time(double shortest_s, double longest_s, bool own,
                                       const std::function<Means(double)>& family) const {
  constexpr double kEachOctave = 2.0;
  const auto count = static_cast<Index>(1.0 + kEachOctave * std::log2(longest_s / shortest_s));
  Eigen::MatrixXd scores(left_.size(), count);
  BestTime out;
  for (Index i = 0; i < count; ++i) {
    const double seconds = shortest_s * std::exp2(static_cast<double>(i) / kEachOctave);
    scores.col(i) = whitened(family(seconds));
    const double one = gain(scores.col(i), own);
    if (one > out.gain) out = {seconds, one};
  }
  out.path = path_length(scores);
  if (!(out.gain > 0.0)) return out;
  const double step = std::log(2.0) / kEachOctave;
  const double middle = std::log(out.seconds);
  const Peak peak = peak_between(middle - step, middle + step, 0.2 * step, [&](double at) {
    return gain(whitened(family(std::exp(at))), own);
  });
  if (peak.gain > out.gain) {
    out.seconds = std::exp(peak.at);
    out.gain = peak.gain;
  }
  out.log_error = peak.error;
  out.information = whitened(family(out.seconds)).squaredNorm();
  return out;
}

}  // namespace imunoise
