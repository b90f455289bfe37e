#include "study/export/imu_noise.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "recording/import/table/names.h"
#include "study/words/number.h"

namespace imunoise::study {
namespace {

double square_sum(double a, double b) { return std::sqrt(a * a + b * b); }

std::optional<Markov> markov_of(const Process& process, Hertz rate) {
  Markov out;
  if (!std::holds_alternative<Ar1>(process) && !std::holds_alternative<GaussMarkov>(process))
    return std::nullopt;
  for (const DerivedQuantity& one : derived(process, rate)) {
    if (one.coefficient == Coefficient::kAmplitude) out.sigma = one.value;
    if (one.coefficient == Coefficient::kCorrelationTime) out.tc = one.value;
  }
  if (!(out.tc >= kSlowest) || !(out.sigma > 0.0)) return std::nullopt;
  return out;
}

// Of white noise, also behind a filter: the consumer's times are longer than it. 0: it is none.
double white_density(const Process& process, Hertz rate) {
  for (const DerivedQuantity& one : derived(process, rate))
    if (one.coefficient == Coefficient::kRandomWalk) return one.value;
  return 0.0;
}

const AxisNoise& largest(const std::vector<AxisNoise>& axes, Bounded AxisNoise::*what) {
  return *std::max_element(axes.begin(), axes.end(), [&](const AxisNoise& a, const AxisNoise& b) {
    return (a.*what).value < (b.*what).value;
  });
}

Bounded root_mean_square(const std::vector<AxisNoise>& axes, Bounded AxisNoise::*what) {
  double value = 0.0;
  double variance = 0.0;  // of the mean of squares, from half-widths of independent intervals
  bool bounded = true;
  const auto count = static_cast<double>(axes.size());
  for (const AxisNoise& one : axes) {
    const Bounded& b = one.*what;
    value += b.value * b.value / count;
    const double half = 0.5 * (b.upper * b.upper - b.lower * b.lower) / count;
    variance += half * half;
    bounded = bounded && b.bounded();
  }
  const double root = std::sqrt(value);
  if (!bounded) return {root, 0.0, 0.0};
  const double half = std::sqrt(variance);
  return {root, std::sqrt(std::max(value - half, 0.0)), std::sqrt(value + half)};
}

std::string names_of(const std::vector<AxisNoise>& axes) {
  std::string out;
  for (const AxisNoise& one : axes) out += (out.empty() ? "" : ", ") + one.channel;
  return out;
}

template <class T>
void add_new(const std::vector<T>& from, std::vector<T>& to) {
  for (const T& one : from)
    if (std::find(to.begin(), to.end(), one) == to.end()) to.push_back(one);
}

AxisNoise combined(const std::vector<AxisNoise>& axes, AxisRule rule) {
  AxisNoise out = largest(axes, &AxisNoise::n);
  out.axis = ' ';
  if (rule == AxisRule::kMean) {
    out.n = root_mean_square(axes, &AxisNoise::n);
    out.k = root_mean_square(axes, &AxisNoise::k);
  } else {
    out.k = largest(axes, &AxisNoise::k).k;
  }
  out.markov.reset();
  for (const AxisNoise& one : axes) {
    if (one.markov && (!out.markov || one.markov->sigma > out.markov->sigma))
      out.markov = one.markov;
    add_new(one.left_out, out.left_out);
    add_new(one.remarks, out.remarks);
  }
  return out;
}

}  // namespace

std::string term_words(const Process& process, Quantity quantity, Hertz rate) {
  std::string out(info(process).title);
  std::string separator = ": ";
  for (const DerivedQuantity& one : derived(process, rate)) {
    const CoefficientUnits units = coefficient_units(one.coefficient, quantity);
    const bool customary = !units.datasheet.empty();
    out += fmt::format("{}{} {}", separator,
                       report::brief(one.value * (customary ? units.to_datasheet : 1.0), 3,
                                     report::Digits::kPlain),
                       customary ? units.datasheet : units.si);
    separator = ", ";
  }
  return out;
}

AxisNoise axis_noise(std::string channel, Quantity quantity, Hertz rate, Model noise) {
  AxisNoise out;
  out.axis = recording::role_of(channel).axis;
  out.channel = std::move(channel);
  out.rate = rate;
  for (const Term& term : noise.terms) {
    for (const DerivedQuantity& one : derived(term.process, rate)) {
      const CoefficientUnits units = coefficient_units(one.coefficient, quantity);
      out.coefficients.push_back({std::string(info(term.process).name),
                                  std::string(units.symbol),
                                  std::string(units.title),
                                  {one.value},
                                  units.si,
                                  units.datasheet,
                                  units.to_datasheet});
    }
    if (!(values(term.process).front() > 0.0)) continue;  // nothing is lost with it
    const std::string words = term_words(term.process, quantity, rate);
    if (const double density = white_density(term.process, rate); density > 0.0) {
      out.n.value = square_sum(out.n.value, density);
    } else if (const auto* walk = std::get_if<RandomWalk>(&term.process)) {
      out.k.value = square_sum(out.k.value, std::sqrt(walk->gamma2 * rate.value));
      out.walk_words = words;
    } else {
      const auto slow = markov_of(term.process, rate);
      if (slow && (!out.markov || slow->tc > out.markov->tc)) {
        out.markov = slow;
        out.markov_words = words;
      }
      out.left_out.push_back(words);
    }
  }
  out.noise = std::move(noise);
  return out;
}

SensorNoise reduced(const SensorNoise& sensor, AxisRule rule) {
  if (sensor.axes.empty()) return sensor;
  SensorNoise out{sensor.quantity, {}};
  const std::string names = names_of(sensor.axes);
  if (rule != AxisRule::kEach) {
    out.axes = {combined(sensor.axes, rule)};
    out.reduction =
        sensor.axes.size() == 1
            ? names
            : fmt::format("{} of {}", rule == AxisRule::kMean ? "root mean square" : "worst",
                          names);
  } else if (sensor.axes.size() == 3) {
    out.axes = sensor.axes;
    std::stable_sort(out.axes.begin(), out.axes.end(),
                     [](const AxisNoise& a, const AxisNoise& b) { return a.axis < b.axis; });
    out.reduction = "each of " + names_of(out.axes);
  } else {
    out.axes.assign(3, combined(sensor.axes, AxisRule::kWorst));
    out.reduction = "all three axes from " + names;
  }
  return out;
}

}  // namespace imunoise::study
