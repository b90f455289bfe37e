#include "daemon/live/live_variance.h"

#include <utility>

namespace imunoise::live {
namespace {

constexpr std::size_t kMean = 256;      // values that make one of the next level
constexpr std::int64_t kLargest = 512;  // half-width of a level's largest scale, in its values
constexpr std::int64_t kSmallest =
    4;  // of the levels above the first: the one below knows the rest

// Half-widths of a level, in its own values.
Scales scales_of(std::size_t level) {
  std::vector<std::int64_t> out;
  for (std::int64_t m = level == 0 ? 1 : kSmallest; m <= kLargest; m *= 2) out.push_back(m);
  return Scales(std::move(out));
}

double samples_of(std::size_t level) {
  double out = 1.0;
  for (std::size_t i = 0; i < level; ++i) out *= static_cast<double>(kMean);
  return out;
}

}  // namespace

LiveVariance::LiveVariance(Hertz rate, double scale) : rate_(rate), scale_(scale) {
  for (std::size_t level = 0; level < kLevels; ++level) {
    levels_.push_back({fresh(level), std::vector<Total>(scales_of(level).size())});
  }
}

StreamingVariance<double> LiveVariance::fresh(std::size_t level) const {
  return {scales_of(level), Hertz{rate_.value / samples_of(level)}, Quantity::kUnknown, scale_};
}

void LiveVariance::push(double number) { push(0, number); }

void LiveVariance::push(std::size_t level, double value) {
  Level& to = levels_[level];
  to.now.push({&value, 1});
  if (level + 1 == kLevels) return;
  to.mean_sum += value;
  if (++to.mean_count < kMean) return;
  push(level + 1, to.mean_sum / static_cast<double>(kMean));
  to.mean_sum = 0.0;
  to.mean_count = 0;
}

// The piece under way counts, too.
std::vector<LiveVariance::Total> LiveVariance::total(const Level& level) {
  std::vector<Total> out = level.before;
  const WaveletVariance piece = level.now.estimate();
  for (std::size_t i = 0; i < piece.scales.size(); ++i) {
    const auto at = static_cast<Eigen::Index>(i);
    const double coefficients =
        static_cast<double>(piece.samples) - 2.0 * static_cast<double>(piece.scales[i]) + 1.0;
    out[i].squares += coefficients * piece.variance[at];
    out[i].coefficients += coefficients;
    out[i].degrees += piece.edof[at];
  }
  return out;
}

void LiveVariance::gap() {
  for (std::size_t i = 0; i < kLevels; ++i) levels_[i] = {fresh(i), total(levels_[i])};
}

std::vector<KnownScale> LiveVariance::known() const {
  std::vector<KnownScale> out;
  for (std::size_t level = 0; level < kLevels; ++level) {
    const Scales scales = scales_of(level);
    const std::vector<Total> totals = total(levels_[level]);
    for (std::size_t i = 0; i < scales.size(); ++i) {
      const Total& one = totals[i];
      if (one.coefficients <= 0.0) continue;
      const double tau = 2.0 * static_cast<double>(scales[i]) * samples_of(level) / rate_.value;
      out.push_back({tau, one.squares / one.coefficients, one.degrees});
    }
  }
  return out;
}

}  // namespace imunoise::live
