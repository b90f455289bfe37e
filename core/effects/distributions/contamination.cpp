#include "core/effects/distributions/contamination.h"

#include <algorithm>
#include <cmath>
#include <numbers>

#include "core/support/distributions.h"
#include "core/support/roots.h"

namespace imunoise {
namespace {

// Mean square of normal numbers of standard deviation `width` that lie beyond ±above.
double mean_square_beyond(double above, double width) {
  const double a = above / width;
  const double density = std::exp(-0.5 * a * a) / std::sqrt(2.0 * std::numbers::pi);
  return width * width * (1.0 + a * density / normal_tail(a));
}

}  // namespace

double Contamination::log_ratio(double z) const {
  const double wide = 0.5 * z * z * (1.0 - 1.0 / (width * width)) + std::log(share / width);
  const double more = std::max(wide, std::log1p(-share));
  return more + std::log1p(std::exp(std::min(wide, std::log1p(-share)) - more));
}

double Contamination::even_chance() const {
  return std::sqrt(2.0 * std::log((1.0 - share) * width / share) / (1.0 - 1.0 / (width * width)));
}

std::optional<Contamination> contamination_of(double count, double samples, double above,
                                              double mean_square) {
  const auto excess = [&](double log_width) {
    return mean_square_beyond(above, std::exp(log_width)) - mean_square;
  };
  const double widest = 0.5 * std::log(mean_square);  // of these themselves
  if (!(excess(0.0) < 0.0) || !(excess(widest) > 0.0)) return std::nullopt;
  const double width = std::exp(root_between(excess, 0.0, widest));
  const double beyond = 2.0 * normal_tail(above / width);
  return Contamination{std::min(0.5, count / (samples * beyond)), width};
}

}  // namespace imunoise
