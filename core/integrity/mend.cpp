#include "core/integrity/mend.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdlib>

#include "core/support/distributions.h"
#include "core/support/linear_algebra.h"
#include "core/support/random.h"

namespace imunoise {
namespace {

using Index = std::ptrdiff_t;

constexpr Index kReach = 8;    // neighbours to each side
constexpr Index kLevel = 256;  // samples to each side whose mean is the level of the noise

// Autocovariance of what departs from the level, for each distance between two neighbours.
using Autocovariance = std::array<double, 2 * kReach + 1>;

// The mean of the known samples around each; 0 where there are none.
std::vector<double> levels(const std::vector<double>& x, const std::vector<bool>& known) {
  const auto n = static_cast<Index>(x.size());
  double sum = 0.0;
  double count = 0.0;
  const auto add = [&](Index t, double sign) {
    if (t < 0 || t >= n || !known[static_cast<std::size_t>(t)]) return;
    sum += sign * x[static_cast<std::size_t>(t)];
    count += sign;
  };
  std::vector<double> out;
  out.reserve(x.size());
  for (Index t = 0; t < kLevel; ++t) add(t, 1.0);
  for (Index t = 0; t < n; ++t) {
    add(t + kLevel, 1.0);
    add(t - kLevel - 1, -1.0);
    out.push_back(count > 0.0 ? sum / count : 0.0);
  }
  return out;
}

Autocovariance autocovariance_of(const std::vector<double>& x, const std::vector<bool>& known) {
  Autocovariance out{};
  for (std::size_t h = 0; h < out.size(); ++h) {
    double sum = 0.0;
    std::size_t count = 0;
    for (std::size_t t = h; t < x.size(); ++t) {
      if (!known[t] || !known[t - h]) continue;
      sum += x[t] * x[t - h];
      ++count;
    }
    out[h] = count == 0 ? 0.0 : sum / static_cast<double>(count);
  }
  return out;
}

struct Prediction {
  double mean = 0.0;
  double deviation = 0.0;  // not finite: the neighbours determine nothing
};

Prediction predicted(const std::vector<double>& x, const std::vector<bool>& known, Index at,
                     const Autocovariance& covariance) {
  std::vector<Index> near;
  for (Index t = std::max<Index>(0, at - kReach); t <= at + kReach; ++t) {
    if (t != at && t < static_cast<Index>(x.size()) && known[static_cast<std::size_t>(t)])
      near.push_back(t);
  }
  const auto size = static_cast<Index>(near.size());
  if (size == 0) return {0.0, NAN};
  const auto between = [&](Index i, Index j) {
    return covariance[static_cast<std::size_t>(std::abs(i - j))];
  };
  Eigen::MatrixXd all(size, size);
  Eigen::VectorXd with(size);
  Eigen::VectorXd values(size);
  for (Index i = 0; i < size; ++i) {
    const Index one = near[static_cast<std::size_t>(i)];
    with(i) = between(one, at);
    values(i) = x[static_cast<std::size_t>(one)];
    for (Index j = 0; j < size; ++j) all(i, j) = between(one, near[static_cast<std::size_t>(j)]);
  }
  const Eigen::VectorXd weights = solve_symmetric(all, with);
  return {weights.dot(values), std::sqrt(covariance[0] - weights.dot(with))};
}

// A normal number; beyond `least` if it is to be on that side of it.
double draw(RandomStream& random, const Prediction& from, double least, int beyond) {
  const double normal = random.normal();
  if (beyond == 0) return from.mean + from.deviation * normal;
  const double tail = normal_tail(beyond * (least - from.mean) / from.deviation);
  const double chance = tail * normal_tail(normal);
  if (!(chance > 0.0 && chance < 1.0)) return NAN;
  return from.mean - beyond * from.deviation * normal_quantile(chance);
}

}  // namespace

std::vector<double> mended(const Signal& signal, std::span<const WrongSample> wrong) {
  // Moments suffer from what is wrong, most of all from what was cut off: those of what was mended
  // are better, and settle soon.
  constexpr int kPasses = 3;
  constexpr std::uint64_t kSeed = 1;
  const double offset = signal.value(0);  // which would cost digits
  std::vector<double> given(signal.size());
  for (std::size_t t = 0; t < given.size(); ++t) given[t] = signal.value(t) - offset;
  std::vector<double> out = given;
  std::vector<bool> known(given.size(), true);
  for (const WrongSample& one : wrong) known[one.at] = one.beyond != 0;
  for (int pass = 0; pass < kPasses; ++pass) {
    const std::vector<double> level = levels(out, known);
    for (std::size_t t = 0; t < out.size(); ++t) out[t] -= level[t];
    const Autocovariance covariance = autocovariance_of(out, known);
    for (const WrongSample& one : wrong) known[one.at] = false;
    RandomStream random(kSeed);
    for (const auto& [at, beyond] : wrong) {
      const Prediction from = predicted(out, known, static_cast<Index>(at), covariance);
      const double drawn = draw(random, from, given[at] - level[at], beyond);
      out[at] = std::isfinite(drawn) ? drawn : given[at] - level[at];
      known[at] = true;
    }
    for (std::size_t t = 0; t < out.size(); ++t) out[t] += level[t];
  }
  for (std::size_t t = 0; t < given.size(); ++t) given[t] = signal.value(t);
  for (const WrongSample& one : wrong) given[one.at] = out[one.at] + offset;
  return given;
}

}  // namespace imunoise
