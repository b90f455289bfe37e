#include "study/deviation/deviations.h"

#include <algorithm>
#include <cmath>
#include <map>

#include "core/support/distributions.h"

namespace imunoise::study {
namespace {

struct Pooled {
  double weight = 0.0;
  double variance = 0.0;  // sum of weight · variance
};

std::map<std::size_t, Pooled> pool(const Series& series, DeviationKind kind) {
  std::map<std::size_t, Pooled> out;
  for (const Signal& signal : series.replicates) {
    const std::vector<std::size_t> factors = customary_factors(kind, signal.size());
    const Eigen::ArrayXd variance = deviation_variance(kind, signal, factors);
    for (std::size_t j = 0; j < factors.size(); ++j) {
      const auto weight = static_cast<double>(difference_count(kind, signal.size(), factors[j]));
      Pooled& at = out[factors[j]];
      at.weight += weight;
      at.variance += weight * variance(static_cast<Eigen::Index>(j));
    }
  }
  return out;
}

std::string law_name(NoiseType law) {
  if (law == NoiseType::kQuantisation) return "QN";
  return law == NoiseType::kWhite ? "WN" : "RW";
}

double degrees_of(const Series& series, DeviationKind kind, NoiseType law, std::size_t m) {
  double out = 0.0;
  for (const Signal& signal : series.replicates) {
    if (difference_count(kind, signal.size(), m) > 0)
      out += deviation_degrees(kind, law, signal.size(), m);
  }
  return out;
}

struct Point {
  std::size_t m = 0;
  double variance = 0.0;
  double white_degrees = 0.0;  // of freedom, if the noise is white
};

// By the slope of log variance over log τ, from the neighbours of a point. Rounding has by far the
// most degrees of freedom: it has to be steeper than white noise beyond chance.
NoiseType law_at(const std::vector<Point>& points, std::size_t i) {
  constexpr double kBeyondChance = 3.0;
  const Point& left = points[i > 0 ? i - 1 : i];
  const Point& right = points[std::min(i + 1, points.size() - 1)];
  if (!(left.variance > 0.0 && right.variance > 0.0) || left.m == right.m) return NoiseType::kWhite;
  const double width = std::log(static_cast<double>(right.m) / static_cast<double>(left.m));
  const double slope = std::log(right.variance / left.variance) / width;
  const double error = std::sqrt(2.0 / left.white_degrees + 2.0 / right.white_degrees) / width;
  const NoiseType law = nearest_law(slope);
  constexpr double kKnown = 30.0;  // degrees of freedom
  const bool few = std::min(left.white_degrees, right.white_degrees) < kKnown;
  const bool chance =
      law == NoiseType::kQuantisation && (few || slope > -1.0 - kBeyondChance * error);
  return chance ? NoiseType::kWhite : law;
}

void add_minimum(v1::DeviationReport& to) {
  std::vector<double> curve;
  for (const v1::DeviationPoint& one : to.points()) curve.push_back(one.deviation());
  const auto lowest = to.points().begin() + static_cast<std::ptrdiff_t>(lowest_deviation(curve));
  v1::DeviationMinimum& out = *to.mutable_minimum();
  out.set_tau_s(lowest->tau_s());
  out.set_deviation(lowest->deviation());
  if (to.kind() == "Allan") out.set_bias_instability(lowest->deviation() / kFlickerFloor);
  out.set_at_edge(lowest + 1 == to.points().end());
}

}  // namespace

Result<v1::DeviationReport> deviations(const Series& series, DeviationKind kind,
                                       double confidence) {
  const std::map<std::size_t, Pooled> pooled = pool(series, kind);
  if (pooled.empty()) return fail(series.channel + ": too few samples for a deviation");
  const Signal& first = series.replicates.front();
  v1::DeviationReport out;
  out.set_channel(series.channel);
  out.set_unit(std::string(si_symbol(first.quantity())));
  out.set_rate_hz(first.rate().value);
  out.set_kind(kind == DeviationKind::kAllan ? "Allan" : "Hadamard");
  out.set_confidence(confidence);
  out.set_replicates(static_cast<std::uint32_t>(series.replicates.size()));
  std::vector<Point> curve;
  for (const auto& [m, sum] : pooled)
    curve.push_back({m, sum.variance / sum.weight, degrees_of(series, kind, NoiseType::kWhite, m)});
  const double tail = 0.5 * (1.0 - confidence);
  for (std::size_t i = 0; i < curve.size(); ++i) {
    const auto& [m, variance, white_degrees] = curve[i];
    const NoiseType law = law_at(curve, i);
    const double degrees =
        law == NoiseType::kWhite ? white_degrees : degrees_of(series, kind, law, m);
    v1::DeviationPoint& point = *out.add_points();
    point.set_samples(static_cast<std::uint32_t>(m));
    point.set_tau_s(static_cast<double>(m) / first.rate().value);
    point.set_deviation(std::sqrt(variance));
    point.set_lower(std::sqrt(variance * degrees / chi_square_quantile(1.0 - tail, degrees)));
    point.set_upper(std::sqrt(variance * degrees / chi_square_quantile(tail, degrees)));
    point.set_degrees_of_freedom(degrees);
    point.set_noise(law_name(law));
  }
  add_minimum(out);
  return out;
}

}  // namespace imunoise::study
