#include "core/diagnosis/views/error_views.h"

#include <algorithm>
#include <cmath>
#include <optional>

#include "core/diagnosis/views/averaging_times.h"
#include "core/diagnosis/views/normal_power.h"
#include "core/diagnosis/views/strongest_wave.h"
#include "core/diagnosis/views/witness_share.h"
#include "core/support/distributions.h"

namespace imunoise {
namespace {

constexpr double kPercent = 100.0;
constexpr double kLimitLevel = 0.05;

// The root mean square of deviations in %, from the χ² of their scores; see ErrorView.
// `information`: Σ 1/s².
std::optional<ErrorView> mean_view(std::string_view view, const TestOutcome& test,
                                   double information) {
  if (test.degrees_of_freedom == 0 || !(information > 0.0)) return std::nullopt;
  const auto dof = static_cast<double>(test.degrees_of_freedom);
  const auto size = [&](double chi) { return kPercent * std::sqrt(chi / information); };
  return ErrorView{.view = view,
                   .unit = "%",
                   .value = size(test.statistic),
                   .floor = size(dof),
                   .chance_limit = size(chi_square_quantile(1.0 - kLimitLevel, dof)),
                   .p_value = test.p_value};
}

// The element of a range at which a measure is largest.
template <class Range, class Measure>
auto worst_of(const Range& range, const Measure& measure) {
  return std::max_element(range.begin(), range.end(),
                          [&](const auto& a, const auto& b) { return measure(a) < measure(b); });
}

std::optional<ErrorView> over_averaging_times(const FittedModel& fitted, const LeftOver& left) {
  const AveragingTimes at = averaging_times(fitted, left);
  auto out = mean_view("averaging_times", at.test, at.relative.square().inverse().sum());
  if (!out) return out;
  const Eigen::ArrayXd deviation = at.ratio.sqrt() - 1.0;
  Eigen::Index worst = 0;
  (deviation / at.relative).abs().maxCoeff(&worst);
  out->worst = {.from = at.seconds(worst), .to = at.seconds(worst), .deviation = deviation(worst)};
  return out;
}

std::optional<ErrorView> over_spectrum(const MisfitReport& misfit) {
  double total_dof = 0.0;
  for (const BandMisfit& one : misfit.bands) total_dof += one.dof;
  auto out = mean_view("spectrum", misfit.spectrum, 0.5 * total_dof);
  if (!out) return out;
  const BandMisfit& worst =
      *worst_of(misfit.bands, [](const BandMisfit& one) { return std::abs(one.sigma); });
  out->worst = {.from = worst.from, .to = worst.to, .deviation = worst.ratio - 1.0};
  return out;
}

std::optional<ErrorView> over_time(const MisfitReport& misfit, double rate) {
  double total_dof = 0.0;
  for (const TimeMisfit& one : misfit.times) total_dof += (one.to - one.from) * rate;
  auto out = mean_view("noise_over_time", misfit.time, 0.5 * total_dof);
  if (!out) return out;
  const TimeMisfit& worst =
      *worst_of(misfit.times, [](const TimeMisfit& one) { return std::abs(one.sigma); });
  out->worst = {.from = worst.from,
                .to = worst.to,
                .deviation = worst.ratio - 1.0,
                .replicate = worst.replicate};
  return out;
}

std::optional<ErrorView> of_distribution(const MisfitReport& misfit) {
  if (!misfit.excess_within_replicates) return std::nullopt;
  double samples = 0.0;
  for (const ReplicatePower& one : misfit.powers) samples += one.dof;
  const double error = std::sqrt(24.0 / samples);
  const double value = std::abs(*misfit.excess_within_replicates);
  return ErrorView{.view = "distribution",
                   .unit = "1",
                   .value = value,
                   .floor = error,
                   .chance_limit = error * normal_quantile(1.0 - 0.5 * kLimitLevel),
                   .p_value = chi_square_tail(value * value / (error * error), 1.0),
                   .worst = {.deviation = *misfit.excess_within_replicates}};
}

std::optional<ErrorView> over_replicates(const MisfitReport& misfit) {
  double power = 0.0;
  double total_dof = 0.0;
  for (const ReplicatePower& one : misfit.powers) {
    power += one.power * one.dof;
    total_dof += one.dof;
  }
  power /= total_dof;
  const auto score = [&](const ReplicatePower& one) {
    return normal_score(one.power / power, one.dof);
  };
  double chi = 0.0;
  for (const ReplicatePower& one : misfit.powers) chi += score(one) * score(one);
  const auto dof = static_cast<Eigen::Index>(misfit.powers.size()) - 1;
  auto out = mean_view("replicates", chi_square_test(chi, dof), 0.5 * total_dof);
  if (!out) return out;
  const ReplicatePower& worst =
      *worst_of(misfit.powers, [&](const ReplicatePower& one) { return std::abs(score(one)); });
  out->worst = {.deviation = worst.power / power - 1.0, .replicate = worst.replicate};
  return out;
}

double decibels(double ratio) { return 10.0 * std::log10(ratio); }

std::optional<ErrorView> of_single_waves(const Current& current) {
  const std::optional<StrongestWave> found = strongest_wave(current);
  if (!found) return std::nullopt;
  return ErrorView{.view = "single_waves",
                   .unit = "dB",
                   .value = decibels(found->power),
                   .floor = decibels(found->chance_median),
                   .chance_limit = decibels(found->chance_limit),
                   .p_value = found->p_value,
                   .worst = {.from = found->frequency, .to = found->frequency}};
}

std::optional<ErrorView> of_witnesses(const Current& current) {
  const std::optional<WitnessShare> found = witness_share(current);
  if (!found) return std::nullopt;
  return ErrorView{.view = "witnesses",
                   .unit = "%",
                   .value = kPercent * found->share,
                   .floor = kPercent * found->chance_median,
                   .chance_limit = kPercent * found->chance_limit,
                   .p_value = found->p_value,
                   .worst = {.witness = found->witness}};
}

}  // namespace

std::vector<ErrorView> error_views(const FittedModel& fitted, const LeftOver& left,
                                   const MisfitReport& misfit) {
  const Current current = current_of(fitted.regression, fitted.fit);
  std::vector<ErrorView> out;
  const auto add = [&](std::optional<ErrorView> one) {
    if (one) out.push_back(std::move(*one));
  };
  add(over_averaging_times(fitted, left));
  add(over_spectrum(misfit));
  add(of_single_waves(current));
  add(over_time(misfit, current.subject().rate.value));
  add(of_distribution(misfit));
  add(of_witnesses(current));
  add(over_replicates(misfit));
  return out;
}

}  // namespace imunoise
