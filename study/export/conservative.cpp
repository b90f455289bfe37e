#include "study/export/conservative.h"

#include <algorithm>
#include <cmath>
#include <vector>

namespace imunoise::study {
namespace {

constexpr double kPerOctave = 32.0;

// Allan variance of N = 1 and of K = 1 at the sampling rate.
Eigen::ArrayXd unit_white(const Eigen::ArrayXd& m, Hertz rate) {
  return 2.0 * variance(Process(WhiteNoise{rate.value}), m);
}
Eigen::ArrayXd unit_walk(const Eigen::ArrayXd& m, Hertz rate) {
  return 2.0 * variance(Process(RandomWalk{1.0 / rate.value}), m);
}

// N² that a bound needs where K² = walk.
double white_needed(const Eigen::ArrayXd& u, const Eigen::ArrayXd& v, double walk) {
  return std::max(((1.0 - walk * v) / u).maxCoeff(), 0.0);
}

}  // namespace

Eigen::ArrayXd horizon_samples(Hertz rate, const Horizon& horizon) {
  const double first = std::max(std::round(horizon.begin * rate.value), 1.0);
  const double last = std::max(std::round(horizon.end * rate.value), first);
  std::vector<double> out;
  for (double m = first; m < last;
       m = std::max(m + 1.0, std::round(m * std::exp2(1.0 / kPerOctave))))
    out.push_back(m);
  out.push_back(last);
  return Eigen::Map<const Eigen::ArrayXd>(out.data(), static_cast<Eigen::Index>(out.size()));
}

// A linear programme of two unknowns, a = N² and b = K²: minimise mean(a·u + b·v) subject to
// a·u + b·v ≥ 1. The least a for a given b is convex and piecewise linear in b, so the cost is
// convex in b alone.
WhiteAndWalk smallest_bound(const Eigen::ArrayXd& samples, const Eigen::ArrayXd& allan,
                            Hertz rate) {
  const Eigen::ArrayXd u = unit_white(samples, rate) / allan;
  const Eigen::ArrayXd v = unit_walk(samples, rate) / allan;
  // The grid is even in log τ, but for the shortest averaging times: weigh by the step.
  Eigen::ArrayXd weight = Eigen::ArrayXd::Ones(samples.size());
  for (Eigen::Index i = 1; i + 1 < samples.size(); ++i)
    weight(i) = 0.5 * std::log(samples(i + 1) / samples(i - 1));
  if (samples.size() > 2) {
    weight(0) = 0.5 * std::log(samples(1) / samples(0));
    weight(samples.size() - 1) =
        0.5 * std::log(samples(samples.size() - 1) / samples(samples.size() - 2));
  }
  weight /= weight.sum();
  const double cost_u = (weight * u).sum();
  const double cost_v = (weight * v).sum();
  const auto cost = [&](double b) { return cost_u * white_needed(u, v, b) + cost_v * b; };
  double low = 0.0;
  double high = (1.0 / v).maxCoeff();
  for (int step = 0; step < 200; ++step) {
    const double left = low + (high - low) / 3.0;
    const double right = high - (high - low) / 3.0;
    (cost(left) <= cost(right) ? high : low) = cost(left) <= cost(right) ? right : left;
  }
  const double b = cost(0.0) <= cost(low) ? 0.0 : low;
  const double a = white_needed(u, v, b);
  const Eigen::ArrayXd ratio = a * u + b * v;
  return {std::sqrt(a), std::sqrt(b), std::sqrt(ratio.maxCoeff()),
          std::sqrt((weight * ratio).sum())};
}

WhiteAndWalk smallest_bound(const Model& noise, Hertz rate, const Horizon& horizon) {
  const Eigen::ArrayXd m = horizon_samples(rate, horizon);
  return smallest_bound(m, 2.0 * variance(noise, m), rate);
}

double underestimate(const Model& noise, const Model& held, Hertz rate, const Horizon& horizon) {
  const Eigen::ArrayXd m = horizon_samples(rate, horizon);
  return std::sqrt((variance(noise, m) / variance(held, m)).maxCoeff());
}

}  // namespace imunoise::study
