#include "study/export/export.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <set>

#include "core/effects/parse_full_model.h"
#include "core/support/rough.h"
#include "study/export/stand_ins.h"
#include "study/export/whole/array_states.h"
#include "study/export/whole/matrices.h"
#include "study/words/number.h"

namespace imunoise::study {
namespace {

Bounded coefficient(const v1::FitReport& fit, std::string_view symbol, double value) {
  Bounded out{value, 0.0, 0.0};
  int found = 0;
  for (const v1::Term& term : fit.terms()) {
    for (const v1::Coefficient& one : term.coefficients()) {
      if (one.symbol() != symbol) continue;
      ++found;
      if (one.has_lower() && one.has_upper()) {
        out.lower = one.lower();
        out.upper = one.upper();
      }
    }
  }
  return found == 1 ? out : Bounded{value, 0.0, 0.0};
}

// The random walk may be zero, for all that the data show.
bool hides_walk(const v1::FitReport& fit) {
  const std::string_view walk = info(Process(RandomWalk{})).name;
  return std::any_of(fit.terms().begin(), fit.terms().end(), [&](const v1::Term& term) {
    return term.name() == walk && term.parameters_size() > 0 &&
           term.parameters(0).observability() == v1::upper_bound_only;
  });
}

Result<AxisNoise> axis_of(const v1::FitReport& fit, Quantity quantity) {
  const Hertz rate{fit.rate_hz()};
  auto model = parse_full_model(fit.fitted_model(), rate);
  if (!model) return tl::unexpected(model.error());
  if (!complete(model->noise))
    return fail(
        fmt::format("{}: the fitted model '{}' has no values", fit.channel(), fit.fitted_model()));
  AxisNoise out = axis_noise(fit.channel(), quantity, rate, std::move(model->noise));
  if (fit.has_p_value() && fit.degrees_of_freedom() > 0) out.p_value = fit.p_value();
  out.confidence = fit.confidence();
  out.n = coefficient(fit, "N", out.n.value);
  out.k = coefficient(fit, "K", out.k.value);
  out.hidden_walk = out.k.upper > 0.0 && hides_walk(fit);
  // The report lists the same coefficients in the same order, with intervals.
  std::size_t at = 0;
  for (const v1::Term& term : fit.terms()) {
    for (const v1::Coefficient& one : term.coefficients()) {
      if (at >= out.coefficients.size() || out.coefficients[at].symbol != one.symbol()) continue;
      Bounded& value = out.coefficients[at++].value;
      if (one.has_lower() && one.has_upper()) value = {value.value, one.lower(), one.upper()};
    }
  }
  for (const EffectTerm& effect : model->effects) out.effects.push_back(print(effect));
  return out;
}

// Probability that the bound holds at the next power-on.
constexpr double kNextPowerOn = 0.95;

void make_conservative(AxisNoise& axis, Quantity quantity, const Consumer& to,
                       const Horizon& horizon) {
  const Eigen::ArrayXd m = horizon_samples(axis.rate, horizon);
  Eigen::ArrayXd allan = 2.0 * variance(axis.noise, m);
  if (!axis.draws.empty())
    allan = allan.max(power_on_allan(axis.noise, axis.draws, m, kNextPowerOn));
  if (axis.hidden_walk) {
    const double more = axis.k.upper * axis.k.upper - axis.k.value * axis.k.value;
    allan += 2.0 * variance(Process(RandomWalk{more / axis.rate.value}), m);
    axis.remarks.push_back(fmt::format(
        "{}: the data show no random walk; the bound includes the largest one that they allow",
        axis.channel));
  }
  const WhiteAndWalk bound = smallest_bound(m, allan, axis.rate);
  axis.n = {bound.n, 0.0, 0.0};
  axis.k = {bound.k, 0.0, 0.0};
  axis.markov.reset();
  axis.left_out.clear();
  make_positive(axis, to, horizon);
  axis.bound = held_by(to, axis);
  axis.coefficients = axis_noise(axis.channel, quantity, axis.rate, *axis.bound).coefficients;
  axis.remarks.push_back(fmt::format(
      "{}: N and K bound the integrated error of the whole model over {}; they "
      "overstate it by a factor of up to {:.2f} ({:.2f} in the mean square){}",
      axis.channel, horizon_words(horizon), bound.most, bound.usual,
      to.takes_walk ? "" : "; this file has no place for K, and N alone bounds nothing"));
  if (axis.draws.empty()) return;
  const double average = std::sqrt((variance(*axis.bound, m) / variance(axis.noise, m)).maxCoeff());
  axis.remarks.push_back(fmt::format(
      "  the bound is that of {:g} % of power-ons at each averaging time, up to {:.2f} times the "
      "error of the average one",
      100.0 * kNextPowerOn, average));
}

// How replicates differ is shown, whatever is written.
void tell_draws(const AxisNoise& axis, bool bounded, std::vector<std::string>& remarks) {
  if (axis.draws.empty()) return;
  remarks.push_back(fmt::format(
      "{}: parameters differ between replicates beyond chance{}:", axis.channel,
      bounded ? "" : "; the values are their average (--conservative bounds the next power-on)"));
  for (const ParameterDraw& one : axis.draws) remarks.push_back(fmt::format("  {}", one.words));
}

std::string fit_words(const AxisNoise& axis) {
  if (!axis.p_value) return "";
  const std::string p = report::p_value(*axis.p_value, report::Digits::kPlain);
  const std::string equal = p.starts_with("<") ? "p " + p : "p = " + p;
  if (*axis.p_value < 0.01) return fmt::format("; it does NOT fit ({})", equal);
  return fmt::format("; {} ({})", *axis.p_value < 0.05 ? "it is doubtful that it fits" : "it fits",
                     equal);
}

void add_sensor(const SensorNoise& from, const SensorNoise& given, const Consumer& to,
                const ExportOptions& options, std::vector<std::string>& heading) {
  const bool gyro = from.quantity == Quantity::kAngularRate;
  const std::string name = gyro ? "gyroscope" : "accelerometer";
  if (from.axes.empty()) {
    heading.push_back(fmt::format("{}: none in the source", name));
    return;
  }
  heading.push_back(fmt::format("{}, sampled at {:g} Hz; {}:", name, from.axes.front().rate.value,
                                given.reduction));
  const AxisNoise& first = from.axes.front();
  if (first.n.bounded() || first.k.bounded())
    heading.push_back(fmt::format("  intervals: {:g} % confidence", 100.0 * first.confidence));
  double most = 1.0;
  std::set<std::string> left_out;
  std::vector<std::string> remarks;
  for (const AxisNoise& one : from.axes) {
    heading.push_back(
        fmt::format("  {}: {}{}", one.channel, print_with_values(one.noise), fit_words(one)));
    left_out.insert(one.effects.begin(), one.effects.end());
    if (to.holding == Holding::kDensities)
      left_out.insert(one.left_out.begin(), one.left_out.end());
    remarks.insert(remarks.end(), one.remarks.begin(), one.remarks.end());
    if (to.holding == Holding::kDensities)
      most = std::max(most, underestimate(one.noise, held_by(to, one), one.rate, options.horizon));
  }
  for (const std::string& one : left_out)
    heading.push_back(fmt::format("  {} takes no {}", to.title, one));
  if (most > 1.05) {
    heading.push_back(fmt::format(
        "  What it does not take makes integrated errors over {} up to {} times larger{}.",
        horizon_words(options.horizon), rough(most),
        to.takes_walk ? "; pass --conservative to bound them" : ""));
  }
  for (const std::string& one : remarks) heading.push_back("  " + one);
}

std::vector<std::string> origin_words(std::string_view of, const Consumer& to,
                                      const ExportSource& source) {
  // A program, or a file of its own.
  const std::string_view how = to.holding == Holding::kDensities ? "for" : "as";
  return {
      fmt::format("Noise of {} {} {}, written by imunoise {}", of, how, to.title, IMUNOISE_VERSION),
      fmt::format("source: {}{}", source.name,
                  source.sha256.empty() ? "" : ", sha256 " + source.sha256)};
}

}  // namespace

Result<ImuNoise> imu_noise(const std::vector<SourceFit>& fits) {
  ImuNoise out;
  std::set<std::pair<Quantity, char>> seen;
  for (const auto& [device, fit] : fits) {
    const auto unit = parse_unit(fit.unit());
    SensorNoise* const sensor = !unit                                       ? nullptr
                                : unit->quantity == Quantity::kAngularRate  ? &out.gyro
                                : unit->quantity == Quantity::kAcceleration ? &out.accelerometer
                                                                            : nullptr;
    if (sensor == nullptr) continue;
    auto axis = axis_of(fit, unit->quantity);
    if (!axis) return tl::unexpected(axis.error());
    axis->draws = moving_parameters(axis->noise, fit.spread());
    const bool twice = axis->axis != ' ' && !seen.emplace(unit->quantity, axis->axis).second;
    sensor->axes.push_back(std::move(*axis));
    if (twice)
      return fail(
          fmt::format("{} is there twice; choose with --channel or --device", fit.channel()));
    if (sensor->axes.size() <= 3) continue;
    return fail(fmt::format(
        "{} is one axis too many: an IMU has three of a kind; choose with --channel or --device",
        fit.channel()));
  }
  if (out.gyro.axes.empty() && out.accelerometer.axes.empty())
    return fail("no fit of an angular rate or an acceleration; give units with --unit");
  return out;
}

Result<Sheet> export_sheet(const ImuNoise& imu, const Consumer& to, const ExportSource& source,
                           const ExportOptions& options) {
  if (to.write == nullptr) return fail(fmt::format("{}: {}", to.title, to.remark));
  if (options.step && to.step == 0.0)
    return fail(fmt::format("{}: its values do not depend on a step; omit --step", to.title));
  const AxisRule rule = options.axes.value_or(to.axes);
  if (rule == AxisRule::kEach && to.axes != AxisRule::kEach)
    return fail(
        fmt::format("{}: it has one value for all axes; pass --axis worst or mean", to.title));
  if (rule != AxisRule::kEach && to.holding != Holding::kDensities)
    return fail(fmt::format("{}: it has a model for each axis; omit --axis", to.title));
  Sheet out;
  out.heading = origin_words("an IMU", to, source);
  ImuNoise all = imu;
  for (SensorNoise* const sensor : {&all.gyro, &all.accelerometer}) {
    for (AxisNoise& axis : sensor->axes) {
      tell_draws(axis, options.conservative, axis.remarks);
      if (options.conservative) {
        make_conservative(axis, sensor->quantity, to, options.horizon);
      } else if (to.holding == Holding::kDensities) {
        if (axis.hidden_walk) axis.k.value = 0.0;
        choose_bias(axis, to, options.horizon);
        fill(axis, to, options.horizon);
      }
    }
  }
  if (to.one_time) share_time(all, to, options.horizon);
  const std::pair<const SensorNoise*, SensorNoise*> sensors[] = {
      {&all.gyro, &out.imu.gyro}, {&all.accelerometer, &out.imu.accelerometer}};
  for (const auto& [from, into] : sensors) {
    if (to.holding == Holding::kDensities) {
      *into = reduced(*from, rule);
      // A file for axes has three values also where one stands for all.
      if (to.axes == AxisRule::kEach && into->axes.size() == 1) into->axes.resize(3, into->axes[0]);
    } else {
      *into = *from;
      into->reduction = "each axis";
    }
    add_sensor(*from, *into, to, options, out.heading);
  }
  out.heading.push_back(fmt::format("{} holds {}.", to.title, to.holds));
  if (!to.remark.empty()) out.heading.emplace_back(to.remark);
  if (to.holding == Holding::kStates)
    for (std::string& line : usage_words()) out.heading.push_back(std::move(line));
  if (to.fields != nullptr) out.fields = to.fields(out.imu, options.step.value_or(to.step));
  if (to.holding != Holding::kStates) return out;
  for (const SensorNoise* const sensor : {&out.imu.gyro, &out.imu.accelerometer}) {
    for (const AxisNoise& axis : sensor->axes) {
      auto system = state_space(axis.bound.value_or(axis.noise), axis.channel, axis.rate);
      if (!system) return tl::unexpected(Error{axis.channel + ": " + system.error().message});
      out.systems.push_back(std::move(*system));
    }
  }
  return out;
}

Result<std::string> export_array(const v1::ArrayReport& report, const Consumer& to,
                                 const ExportSource& source) {
  if (to.holding != Holding::kStates)
    return fail(
        fmt::format("{}: it takes no arrays; write matrices with --to kf-json, kf-numpy, "
                    "kf-matlab or kf-cpp",
                    to.title));
  auto systems = array_systems(report);
  if (!systems) return tl::unexpected(systems.error());
  Sheet sheet;
  sheet.heading = origin_words("an array", to, source);
  sheet.heading.push_back(
      fmt::format("model: {}, sampled at {:g} Hz", report.model(), report.rate_hz()));
  for (std::string& line : usage_words()) sheet.heading.push_back(std::move(line));
  sheet.systems = std::move(*systems);
  return to.write(sheet);
}

Result<std::string> export_noise(const ImuNoise& imu, const Consumer& to,
                                 const ExportSource& source, const ExportOptions& options) {
  const auto sheet = export_sheet(imu, to, source, options);
  if (!sheet) return tl::unexpected(sheet.error());
  return to.write(*sheet);
}

}  // namespace imunoise::study
