#include "core/effects/distributions/tails.h"

#include <algorithm>
#include <cmath>

#include "core/effects/distributions/contamination.h"

namespace imunoise {
namespace {

struct Mixture {
  double narrow = 1.0;  // standard deviation
  Contamination far;    // of deviations in units of that

  double log_density(double size) const {
    const double z = size / narrow;
    return log_normal_density(z) - std::log(narrow) + far.log_ratio(z);
  }
  // Probability that a deviation of this size is a far one.
  double chance(double size) const {
    const double z = size / narrow;
    return std::exp(std::log(far.share / far.width) + log_normal_density(z / far.width) -
                    log_normal_density(z) - far.log_ratio(z));
  }
};

// Expectation and maximisation (Dempster, Laird & Rubin 1977) from a start.
Mixture climbed(const SizeCounts& sizes, Mixture from) {
  constexpr int kSteps = 300;
  constexpr double kLeastShare = 1e-7;
  constexpr double kMostShare = 0.02;  // more are not single samples
  for (int step = 0; step < kSteps; ++step) {
    double all = 0.0;
    double of_far = 0.0;
    double near_squares = 0.0;
    double far_squares = 0.0;
    for (std::size_t i = 0; i < sizes.count.size(); ++i) {
      if (!(sizes.count[i] > 0.0)) continue;
      const double size = SizeCounts::size(i);
      const double chance = from.chance(size);
      all += sizes.count[i];
      of_far += sizes.count[i] * chance;
      far_squares += sizes.count[i] * chance * size * size;
      near_squares += sizes.count[i] * (1.0 - chance) * size * size;
    }
    const Mixture before = from;
    from.narrow = std::sqrt(near_squares / std::max(all - of_far, 1.0));
    from.far.share = std::clamp(of_far / all, kLeastShare, kMostShare);
    if (of_far > 0.0) from.far.width = std::max(1.0, std::sqrt(far_squares / of_far) / from.narrow);
    if (std::abs(from.far.share - before.far.share) < 1e-6 * before.far.share &&
        std::abs(from.far.width - before.far.width) < 1e-6 * before.far.width)
      break;
  }
  return from;
}

double likelihood(const SizeCounts& sizes, const Mixture& mixture) {
  double out = 0.0;
  for (std::size_t i = 0; i < sizes.count.size(); ++i) {
    if (sizes.count[i] > 0.0) out += sizes.count[i] * mixture.log_density(SizeCounts::size(i));
  }
  return out;
}

// A few far ones, or many near ones: the likelihood has a peak at each.
Mixture best_mixture(const SizeCounts& sizes) {
  Mixture best = climbed(sizes, {1.0, {0.01, 4.0}});
  for (const Contamination& start : {Contamination{1e-4, 8.0}, Contamination{0.02, 2.5}}) {
    const Mixture other = climbed(sizes, {1.0, start});
    if (likelihood(sizes, other) > likelihood(sizes, best)) best = other;
  }
  return best;
}

}  // namespace

TailComparison compare_tails(const SizeCounts& sizes) {
  const Student student = best_student(sizes);
  const Mixture mixture = best_mixture(sizes);
  double all = 0.0;
  double sum = 0.0;
  double squares = 0.0;
  for (std::size_t i = 0; i < sizes.count.size(); ++i) {
    if (!(sizes.count[i] > 0.0)) continue;
    const double size = SizeCounts::size(i);
    const double one = log_density(student, size) - mixture.log_density(size);
    all += sizes.count[i];
    sum += sizes.count[i] * one;
    squares += sizes.count[i] * one * one;
  }
  const double gain = gain_of(sizes, student);
  return {gain, gain - sum, std::sqrt(std::max(0.0, squares - sum * sum / all))};
}

}  // namespace imunoise
