#include "core/wavelet/wavelet_covariance.h"

#include <algorithm>
#include <array>
#include <cassert>
#include <cmath>
#include <memory>

#include "core/support/distributions.h"
#include "core/support/parallel.h"
#include "core/wavelet/squared_coefficients.h"
#include "core/wavelet/wavelet_variance.h"

namespace imunoise {
namespace {

constexpr std::size_t kSegmentBlocks = 64;
constexpr std::int64_t kLongFilter = 256;  // half-width from which κ is its limit
constexpr double kOctave = 0.69;           // ln 2, but for rounding

// 2m·W_t of one signal at one scale, block after block.
class Coefficients {
 public:
  virtual ~Coefficients() = default;
  /// Moves on to a block of prefix sums and writes the coefficients of t in [begin, end) within it.
  virtual void read(std::size_t block, std::size_t begin, std::size_t end, double* out) = 0;
};

template <class Prefix>
class CoefficientsOf : public Coefficients {
 public:
  CoefficientsOf(const Prefix& prefix, std::size_t m)
      : m_(m), now_(prefix, 0, 0), middle_(prefix, m, 0), far_(prefix, 2 * m, 0) {}

  void read(std::size_t block, std::size_t begin, std::size_t end, double* out) override {
    for (auto* window : {&now_, &middle_, &far_}) window->advance(block);
    const auto* a = now_.at(begin);
    const auto* b = middle_.at(begin - m_);
    const auto* c = far_.at(begin - 2 * m_);
    for (std::size_t i = 0; i < end - begin; ++i) {
      out[i] = static_cast<double>(a[i] - 2 * b[i] + c[i]);
    }
  }

 private:
  std::size_t m_;
  PrefixWindow<Prefix> now_;
  PrefixWindow<Prefix> middle_;
  PrefixWindow<Prefix> far_;
};

// A signal's prefix sums, whatever its samples are.
class Source {
 public:
  virtual ~Source() = default;
  virtual std::unique_ptr<Coefficients> at_scale(std::size_t m) const = 0;
};

template <class Sample>
class SourceOf : public Source {
 public:
  using Prefix =
      PrefixSums<Sample, std::conditional_t<std::is_same_v<Sample, double>, double, std::int64_t>>;
  explicit SourceOf(std::span<const Sample> samples) : prefix_(samples) {}
  std::unique_ptr<Coefficients> at_scale(std::size_t m) const override {
    return std::make_unique<CoefficientsOf<Prefix>>(prefix_, m);
  }

 private:
  Prefix prefix_;
};

std::unique_ptr<Source> source_of(const Signal& signal) {
  return std::visit(
      []<class Sample>(std::span<const Sample> samples) -> std::unique_ptr<Source> {
        return std::make_unique<SourceOf<Sample>>(samples);
      },
      signal.samples());
}

// Σ_t of the products of all pairs over one segment of blocks, times 4m² and in stored units.
Eigen::MatrixXd segment_products(const std::vector<std::unique_ptr<Source>>& sources,
                                 std::size_t samples, std::size_t m, std::size_t first_block,
                                 std::size_t end_block) {
  const auto count = static_cast<Eigen::Index>(sources.size());
  std::vector<std::unique_ptr<Coefficients>> coefficients;
  for (const auto& source : sources) coefficients.push_back(source->at_scale(m));
  Eigen::MatrixXd sum = Eigen::MatrixXd::Zero(count, count);
  Eigen::MatrixXd values(kBlock, count);
  for (std::size_t block = first_block; block < end_block; ++block) {
    const std::size_t begin = std::max(block * kBlock, 2 * m);
    const std::size_t end = std::min(samples + 1, (block + 1) * kBlock);
    if (begin >= end) continue;
    for (Eigen::Index i = 0; i < count; ++i) {
      coefficients[static_cast<std::size_t>(i)]->read(block, begin, end, values.col(i).data());
    }
    const auto used = values.topRows(static_cast<Eigen::Index>(end - begin));
    sum.selfadjointView<Eigen::Lower>().rankUpdate(used.transpose());
  }
  return sum.selfadjointView<Eigen::Lower>();
}

// 2m/Σρ², ρ the autocorrelation of white noise's coefficients at half-width m: 1.33, 2.29 .. 3.
double white_pairs_per_window(std::int64_t m) {
  const auto width = static_cast<double>(m);
  double sum = 1.0;
  for (std::int64_t h = 1; h < 2 * std::min<std::int64_t>(m, kLongFilter); ++h) {
    const auto lag = static_cast<double>(h);
    const double rho = lag < width ? 1.0 - 1.5 * lag / width : 0.5 * lag / width - 1.0;
    sum += 2.0 * rho * rho;
  }
  return m < kLongFilter ? 2.0 * width / sum : 3.0;
}

// κ for slopes -1, -1/2 .. 1 of the logarithm of the wavelet variance, linear between them. At
// small half-widths the flatter spectra have fewer: as many times as white noise, a random walk as
// here.
double pairs_per_window(double slope, std::int64_t m) {
  constexpr std::array<double, 5> kKnown = {3.000, 2.520, 2.337, 2.191, 1.854};
  const double at = std::clamp(2.0 * (slope + 1.0), 0.0, 4.0);
  const auto left = std::min<std::size_t>(3, static_cast<std::size_t>(at));
  const double few = std::lerp(white_pairs_per_window(m) / kKnown[0], 1.0, at / 4.0);
  return few * std::lerp(kKnown[left], kKnown[left + 1], at - static_cast<double>(left));
}

// n of covariance_interval(), from the logarithm of the wavelet variance.
Eigen::ArrayXd independent_pairs(const Scales& scales, const Eigen::ArrayXd& log_variance,
                                 std::size_t samples) {
  const Eigen::ArrayXd log_m = scales.half_widths().log();
  Eigen::ArrayXd out = equivalent_degrees(scales, samples);
  for (Eigen::Index j = 0; j < out.size(); ++j) {
    // From the nearest scales an octave or more away, where there are such.
    Eigen::Index low = j;
    Eigen::Index high = j;
    while (low > 0 && log_m(j) - log_m(low) < kOctave) --low;
    while (high + 1 < out.size() && log_m(high) - log_m(j) < kOctave) ++high;
    const double slope =
        high > low ? (log_variance(high) - log_variance(low)) / (log_m(high) - log_m(low)) : 1.0;
    out(j) *=
        pairs_per_window(std::isfinite(slope) ? slope : 1.0, scales[static_cast<std::size_t>(j)]);
  }
  return out;
}

}  // namespace

Eigen::ArrayXd WaveletCovariance::of(Eigen::Index a, Eigen::Index b) const {
  Eigen::ArrayXd out(static_cast<Eigen::Index>(covariance.size()));
  for (std::size_t j = 0; j < covariance.size(); ++j) {
    out(static_cast<Eigen::Index>(j)) = covariance[j](a, b);
  }
  return out;
}

WaveletCovariance wavelet_covariance(std::span<const Signal> signals, const Scales& scales,
                                     const Progress& progress) {
  assert(!signals.empty());
  const std::size_t samples = signals.front().size();
  assert(scales.empty() || static_cast<std::size_t>(2 * scales.largest()) <= samples);
  WaveletCovariance out;
  out.scales = scales;
  out.samples = samples;
  out.rate = signals.front().rate();
  out.quantity = signals.front().quantity();
  std::vector<std::unique_ptr<Source>> sources;
  Eigen::VectorXd unit(static_cast<Eigen::Index>(signals.size()));
  for (std::size_t i = 0; i < signals.size(); ++i) {
    assert(signals[i].size() == samples);
    sources.push_back(source_of(signals[i]));
    unit(static_cast<Eigen::Index>(i)) = signals[i].scale();
  }

  const std::size_t blocks = samples / kBlock + 1;
  const std::size_t segments = (blocks + kSegmentBlocks - 1) / kSegmentBlocks;
  std::vector<Eigen::MatrixXd> parts(scales.size() * segments);
  for_each_index(parts.size(), [&](std::size_t item) {
    if (progress.stopped()) return;
    const std::size_t first = item % segments * kSegmentBlocks;
    parts[item] =
        segment_products(sources, samples, static_cast<std::size_t>(scales[item / segments]), first,
                         std::min(blocks, first + kSegmentBlocks));
    progress.report(static_cast<double>(item + 1) / static_cast<double>(parts.size()));
  });
  for (std::size_t j = 0; j < scales.size(); ++j) {
    const auto m = static_cast<double>(scales[j]);
    const double pairs = static_cast<double>(samples) - 2.0 * m + 1.0;
    Eigen::MatrixXd sum = Eigen::MatrixXd::Zero(unit.size(), unit.size());
    for (std::size_t s = 0; s < segments && !progress.stopped(); ++s)
      sum += parts[j * segments + s];
    out.covariance.emplace_back(unit.asDiagonal() * sum * unit.asDiagonal() /
                                (pairs * 4.0 * m * m));
  }
  return out;
}

CovarianceInterval covariance_interval(const WaveletCovariance& measured, Eigen::Index a,
                                       Eigen::Index b, double confidence, std::size_t replicates) {
  const Eigen::ArrayXd own = measured.of(a, b);
  const Eigen::ArrayXd product = measured.of(a, a) * measured.of(b, b);
  const Eigen::ArrayXd degrees =
      static_cast<double>(replicates) *
      independent_pairs(measured.scales, 0.5 * product.log(), measured.samples);
  Eigen::ArrayXd width = ((product + own.square()) / degrees).sqrt();
  for (Eigen::Index j = 0; j < width.size(); ++j) {
    width(j) *= student_quantile(0.5 + 0.5 * confidence, degrees(j));
  }
  return {own - width, own + width};
}

}  // namespace imunoise
