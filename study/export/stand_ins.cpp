#include "study/export/stand_ins.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <vector>

#include "study/words/number.h"

namespace imunoise::study {
namespace {

Process white(double n, Hertz rate) { return WhiteNoise{n * n * rate.value}; }
Process walk_of(double k, Hertz rate) { return RandomWalk{k * k / rate.value}; }
Process markov_of(double sigma, double tc, Hertz rate) {
  return GaussMarkov{sigma * sigma, tc, rate};
}

// The bias that a consumer will think the axis has.
Process bias_held(const Consumer& to, const AxisNoise& axis) {
  if (to.takes_markov && axis.k.value == 0.0 && axis.markov)
    return markov_of(axis.markov->sigma, axis.markov->tc, axis.rate);
  return walk_of(axis.k.value, axis.rate);
}

// How many times the amplitude of `unit` it takes beside another process, so that both together
// have nowhere less integrated error than the model.
double least_beside(const AxisNoise& axis, const Process& other, const Process& unit,
                    const Horizon& horizon) {
  const Eigen::ArrayXd m = horizon_samples(axis.rate, horizon);
  const Eigen::ArrayXd left = variance(axis.noise, m) - variance(other, m);
  // What rounding leaves of nothing.
  const Eigen::ArrayXd needed = (left > 1e-9 * variance(axis.noise, m)).select(left, 0.0);
  return std::sqrt((needed / variance(unit, m)).maxCoeff());
}

double most_over(const AxisNoise& axis, const Model& held, const Horizon& horizon) {
  return underestimate(held, axis.noise, axis.rate, horizon);
}

Bounded exactly(double value) { return {value, 0.0, 0.0}; }

// The bias of an axis with a given correlation time.
struct Shared {
  double sigma = 0.0;
  double over = 1.0;  // largest ratio of its integrated error to the model's
};

Shared with_time(const AxisNoise& axis, double tc, const Horizon& horizon) {
  const Process unit = markov_of(1.0, tc, axis.rate);
  const Process beside = white(axis.n.value, axis.rate);
  Shared out;
  out.sigma = least_beside(axis, beside, unit, horizon);
  out.over = most_over(axis, {{Term(beside), Term(markov_of(out.sigma, tc, axis.rate))}}, horizon);
  return out;
}

std::vector<AxisNoise*> with_bias(ImuNoise& imu) {
  std::vector<AxisNoise*> out;
  for (SensorNoise* const sensor : {&imu.gyro, &imu.accelerometer}) {
    for (AxisNoise& axis : sensor->axes)
      if (markov_bias(axis).sigma > 0.0) out.push_back(&axis);
  }
  return out;
}

}  // namespace

Model held_by(const Consumer& to, const AxisNoise& axis) {
  return {{Term(white(axis.n.value, axis.rate)), Term(bias_held(to, axis))}};
}

std::string horizon_words(const Horizon& horizon) {
  return fmt::format("{:g} to {:g} s", horizon.begin, horizon.end);
}

void choose_bias(AxisNoise& axis, const Consumer& to, const Horizon& horizon) {
  if (!to.takes_markov || !axis.markov || !(axis.n.value > 0.0)) return;
  AxisNoise by_markov = axis;
  by_markov.k = {};
  const auto missing = [&](const AxisNoise& one) {
    return underestimate(axis.noise, held_by(to, one), axis.rate, horizon);
  };
  if (axis.k.value > 0.0 && missing(axis) <= missing(by_markov)) {
    axis.markov.reset();
    return;
  }
  std::erase(axis.left_out, axis.markov_words);
  if (axis.k.value > 0.0) axis.left_out.push_back(axis.walk_words);
  axis.k = {};
}

void fill(AxisNoise& axis, const Consumer& to, const Horizon& horizon) {
  const bool bias = axis.k.value > 0.0 || (to.takes_markov && axis.markov);
  const bool needs_n = !(axis.n.value > 0.0);
  const bool needs_k = to.takes_walk && !bias && (axis.hidden_walk || !axis.left_out.empty());
  const auto tell = [&](std::string_view missing, std::string_view value) {
    axis.remarks.push_back(fmt::format("{}: the model has no {}; {} bounds its error over {}",
                                       axis.channel, missing, value, horizon_words(horizon)));
  };
  if (needs_n) {
    const double n = bias ? least_beside(axis, bias_held(to, axis), white(1.0, axis.rate), horizon)
                          : smallest_bound(axis.noise, axis.rate, horizon).n;
    axis.n = exactly(n);
    tell("white noise", "N");
  }
  if (needs_k && axis.hidden_walk) {
    axis.k = exactly(axis.k.upper);
    axis.remarks.push_back(
        fmt::format("{}: the data show no random walk; K is its upper bound", axis.channel));
  } else if (needs_k) {
    const double k =
        least_beside(axis, white(axis.n.value, axis.rate), walk_of(1.0, axis.rate), horizon);
    axis.k = exactly(k);
    if (k > 0.0) tell("random walk", "K");
  }
  make_positive(axis, to, horizon);
}

void make_positive(AxisNoise& axis, const Consumer& to, const Horizon& horizon) {
  if (to.takes_zero) return;
  // K²t³/3 is a hundredth of N²t at the end of the horizon, or N²t of K²t³/3 at its beginning.
  const double hundredth = std::sqrt(0.03);
  const auto tell = [&](std::string_view missing, std::string_view value, double at) {
    axis.remarks.push_back(
        fmt::format("{}: the model has no {} and {} refuses 0; {} adds 0.5 % to the integrated "
                    "error over {:g} s",
                    axis.channel, missing, to.title, value, at));
  };
  if (!(axis.n.value > 0.0)) {
    axis.n = exactly(axis.k.value * horizon.begin / (10.0 * std::sqrt(3.0)));
    tell("white noise", "N", horizon.begin);
  }
  if (!(axis.k.value > 0.0) && to.takes_walk) {
    axis.k = exactly(axis.n.value * hundredth / horizon.end);
    tell("random walk", "K", horizon.end);
  }
}

void share_time(ImuNoise& imu, const Consumer& to, const Horizon& horizon) {
  const std::vector<AxisNoise*> axes = with_bias(imu);
  double best = 0.0;
  double least = INFINITY;
  bool differ = false;
  for (const AxisNoise* const candidate : axes) {
    const double tc = markov_bias(*candidate).tc;
    differ = differ || tc != markov_bias(*axes.front()).tc;
    double worst = 1.0;
    for (const AxisNoise* const one : axes)
      worst = std::max(worst, with_time(*one, tc, horizon).over);
    if (!(worst < least)) continue;
    least = worst;
    best = tc;
  }
  if (!differ) return;
  for (AxisNoise* const one : axes) {
    const double own = markov_bias(*one).tc;
    if (own == best) continue;
    const Shared shared = with_time(*one, best, horizon);
    one->k = {};
    one->markov = Markov{shared.sigma, best};
    one->remarks.push_back(fmt::format(
        "{}: {} has one correlation time, {} s; this axis has {}. Its σ bounds the error over "
        "{} and overstates it by a factor of up to {:.2f}",
        one->channel, to.title, report::brief(best, 3, report::Digits::kPlain),
        own == kEndless ? "a random walk" : report::brief(own, 3, report::Digits::kPlain) + " s",
        horizon_words(horizon), shared.over));
  }
}

}  // namespace imunoise::study
