#include "study/analysis/fit_series.h"

#include <fmt/format.h>

#include <algorithm>

#include "core/inference/efficient_fit.h"
#include "core/spectrum/cross_power.h"
#include "core/support/rough.h"
#include "study/analysis/compared_models.h"
#include "study/analysis/prepare.h"
#include "study/analysis/test_series.h"
#include "study/analysis/vocabulary.h"

namespace imunoise::study {
namespace {

Result<void> check_likelihood(const Series& series, const MeasureOptions& measure) {
  if (measure.robust) {
    return fail(
        "estimator: a likelihood is not robust: leave --robust out, or take another estimator");
  }
  for (std::size_t k = 0; k < series.replicates.size(); ++k) {
    if (series.replicates[k].size() >= kFewestSamples) continue;
    return fail(fmt::format("{}: too short for a likelihood: at least {} samples are needed",
                            series.names[k], kFewestSamples));
  }
  return {};
}

// An average of parameters that differ by much describes none of the replicates.
Result<Fit> average_estimate(const Model& model, const std::vector<WaveletVariance>& measured,
                             const FitOptions& options, const Progress& progress) {
  constexpr double kMuch = 4.0;
  const AverageEstimate found = agmwm(model, measured, options.weighting, progress);
  if (found.disagreement > kMuch) {
    return fail(fmt::format(
        "estimator: the fits of the replicates do not match: at some averaging time the mean of "
        "their parameters has a variance {} times too large or too small; use --estimator "
        "mugmwm, or imunoise test to see how the replicates differ",
        rough(found.disagreement)));
  }
  return infer(found, measured, options.confidence);
}

Result<Fit> estimate(const Series& series, const Model& model,
                     const std::vector<WaveletVariance>& measured, const FitOptions& options,
                     const Progress& progress) {
  if (options.estimator == Estimator::kAGmwm)
    return average_estimate(model, measured, options, progress);
  Fit fit =
      infer(mugmwm(model, measured, options.weighting, progress), measured, options.confidence);
  if (options.estimator != Estimator::kWhittle || progress.stopped()) return fit;
  std::vector<BandedPower> powers;
  for (const Signal& signal : series.replicates) powers.push_back(banded_power(signal));
  return make_efficient(std::move(fit), measured, powers, progress);
}

std::string name_of(Estimator estimator, std::size_t replicates) {
  if (estimator == Estimator::kAGmwm) return "AGMWM";
  const std::string moments = moments_estimator(replicates);
  return estimator == Estimator::kWhittle ? likelihood_estimator(moments) : moments;
}

// Terms of which moments at dyadic scales see little (docs/efficiency.md).
bool seen_badly_by_moments(const Model& model) {
  return std::any_of(model.terms.begin(), model.terms.end(), [](const Term& term) {
    return std::holds_alternative<Resonance>(term.process) ||
           std::holds_alternative<RateRamp>(term.process);
  });
}

// What the next power-on may have.
void compare_replicates(const Model& model, const std::vector<WaveletVariance>& measured,
                        const Progress& progress, v1::FitReport& to) {
  constexpr std::size_t kFewest = 3;
  constexpr std::size_t kMost = 50;  // each costs a fit
  if (measured.size() < kFewest || measured.size() > kMost) return;
  const NearStationarity result = near_stationarity(model, measured, {.sets = 0}, progress);
  add_spread(result, measured.front().quantity, *to.mutable_spread());
  const std::string moving = moving_words(to.spread());
  if (!moving.empty())
    to.add_notes(
        fmt::format("Between replicates, parameters differ beyond chance: {}; see imunoise "
                    "test.",
                    moving));
}

}  // namespace

Result<v1::FitReport> fit_series(const Series& series, const FitOptions& options,
                                 const Progress& progress) {
  const Result<Prepared> prepared = prepare(series, options.model ? *options.model : kDefaultModel,
                                            {}, options.measure, progress.part(0.0, 0.6));
  if (!prepared) return tl::unexpected(prepared.error());
  const auto& [left, measured] = *prepared;
  const Model& model = left.noise;
  if (options.estimator == Estimator::kWhittle) {
    if (auto able = check_likelihood(left.series, options.measure); !able)
      return tl::unexpected(able.error());
  }
  const Progress fitting = progress.part(0.6, 0.8);
  const Result<Fit> fit = estimate(left.series, model, measured, options, fitting);
  if (progress.stopped()) return fail("stopped");
  if (!fit) return tl::unexpected(fit.error());
  v1::FitReport out = fit_report(*fit, left.series, measured);
  add_effects(left, fit->estimate.model, out);
  out.set_default_model(!options.model);
  out.set_estimator(name_of(options.estimator, series.replicates.size()));
  if (!options.model) out.add_notes(default_model_note("was fitted"));
  if (options.estimator != Estimator::kWhittle && seen_badly_by_moments(model)) {
    out.add_notes(
        "A resonance or a rate ramp is estimated much more precisely with --estimator whittle, "
        "once "
        "the "
        "model fits.");
  }
  if (auto note = quantisation_note(fit->estimate.model)) out.add_notes(std::move(*note));
  if (options.compare) compare_replicates(model, measured, progress.part(0.8, 1.0), out);
  if (progress.stopped()) return fail("stopped");
  progress.report(1.0);
  return out;
}

}  // namespace imunoise::study
