#include "core/search/evidence.h"

#include <algorithm>
#include <cmath>
#include <numbers>

#include "core/support/distributions.h"
#include "core/support/roots.h"

namespace imunoise {
namespace {

constexpr double kLevelKnown = 1e5;  // degrees of freedom from which Fisher's distribution is χ²

}  // namespace

double log_sum(double a, double b) {
  const double high = std::max(a, b);
  if (!std::isfinite(high)) return high;
  return high + std::log1p(std::exp(std::min(a, b) - high));
}

double log_p_value(double gain_nats, double dof, double noise_dof, bool power) {
  if (!(gain_nats > 0.0) || !(dof > 0.0)) return 0.0;
  if (!std::isfinite(gain_nats)) return -INFINITY;
  const double one_sided = power ? -std::numbers::ln2 : 0.0;
  if (!(noise_dof < kLevelKnown)) return one_sided + log_chi_square_tail(2.0 * gain_nats, dof);
  // The likelihood ratio of a regression on Gaussian noise of unknown level: Λ = (n/2) log(1 +
  // dF/n), n the degrees of freedom left.
  const double f = noise_dof / dof * std::expm1(2.0 * gain_nats / (noise_dof + dof));
  if (!std::isfinite(f)) return -gain_nats;
  return one_sided + log_f_tail(f, dof, noise_dof);
}

double log_p_value(double gain_nats, double dof, double noise_dof, bool power,
                   const Search& search) {
  const double here = log_p_value(gain_nats, dof, noise_dof, power);
  if (!(gain_nats > 0.0) || !(dof > 0.0) || !std::isfinite(here)) return here;
  // Upcrossings of the level u by a χ²_d process: the density of χ_d at √u times the mean upward
  // speed (Davies 1987, after Rice). As much more frequent as the tail is heavier where the noise
  // level is uncertain.
  const double u = std::max(2.0 * gain_nats, dof);
  const double density = 0.5 * (dof - 1.0) * std::log(u) - 0.5 * u -
                         (0.5 * dof - 1.0) * std::numbers::ln2 - std::lgamma(0.5 * dof);
  const double upward = -0.5 * std::log(2.0 * std::numbers::pi);
  const double heavier = here - log_chi_square_tail(2.0 * gain_nats, dof);
  const double crossings = std::log(search.path) + density + upward + heavier;
  return std::min(0.0, search.log_places + log_sum(here, crossings));
}

double gain_needed(double level, double dof, bool power, const Search& search) {
  constexpr double kMost = 1e3;  // nats
  const auto excess = [&](double gain_nats) {
    return log_p_value(gain_nats, dof, INFINITY, power, search) - std::log(level);
  };
  return excess(kMost) < 0.0 ? root_between(excess, 0.0, kMost) : kMost;
}

double log_number(double count) { return count > 0.0 ? std::log(count * (count + 1.0)) : 0.0; }

double path_length(const Eigen::MatrixXd& scores) {
  double out = 0.0;
  for (Eigen::Index i = 1; i < scores.cols(); ++i) {
    const double norms = scores.col(i).norm() * scores.col(i - 1).norm();
    if (!(norms > 0.0)) continue;
    const double cosine = std::abs(scores.col(i).dot(scores.col(i - 1))) / norms;
    out += std::acos(std::min(1.0, cosine));
  }
  return out;
}

}  // namespace imunoise
