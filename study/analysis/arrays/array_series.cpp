#include "study/analysis/arrays/array_series.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "core/array/array_blocks.h"
#include "core/array/array_whittle.h"
#include "core/array/dependence.h"
#include "core/array/sensor_misfit.h"
#include "core/support/holm.h"
#include "study/analysis/arrays/array_parameters.h"
#include "study/analysis/arrays/array_setup.h"
#include "study/analysis/arrays/array_weights.h"
#include "study/analysis/prepare.h"
#include "study/analysis/vocabulary.h"
#include "study/words/number.h"

namespace imunoise::study {
namespace {

void add_scales(const WaveletCovariance& mean, std::size_t replicates,
                const std::vector<Eigen::MatrixXd>& model, const Pair& pair, double confidence,
                v1::SensorPair& to) {
  const CovarianceInterval interval =
      covariance_interval(mean, pair.a, pair.b, confidence, replicates);
  for (std::size_t j = 0; j < mean.scales.size(); ++j) {
    const Eigen::MatrixXd& c = mean.covariance[j];
    const double unit = std::sqrt(c(pair.a, pair.a) * c(pair.b, pair.b));
    if (!(unit > 0.0)) continue;
    v1::CrossScale& scale = *to.add_scales();
    scale.set_tau_s(2.0 * static_cast<double>(mean.scales[j]) / mean.rate.value);
    scale.set_covariance(c(pair.a, pair.b));
    scale.set_lower(interval.lower(static_cast<Eigen::Index>(j)));
    scale.set_upper(interval.upper(static_cast<Eigen::Index>(j)));
    scale.set_model(model[j](pair.a, pair.b));
    scale.set_unit(unit);
  }
}

void add_sensor_fits(const ArrayFit& fit, const Measured& measured, v1::ArrayReport& out) {
  const std::vector<TestOutcome> tests = sensor_misfits(fit.model, measured);
  std::vector<double> p_values;
  for (const TestOutcome& one : tests) p_values.push_back(one.p_value);
  const std::vector<double> adjusted = holm(p_values);
  for (std::size_t i = 0; i < tests.size(); ++i) {
    v1::SensorFit& to = *out.add_sensor_fits();
    to.set_sensor(out.sensors(static_cast<int>(i)));
    to.set_statistic(tests[i].statistic);
    to.set_degrees_of_freedom(tests[i].degrees_of_freedom);
    to.set_p_value(tests[i].p_value);
    to.set_adjusted_p_value(adjusted[i]);
    to.set_fits(adjusted[i] >= kLevel);
  }
}

// The test of a pair takes its scatter from the model: it means something only where that fits.
void evaluate(const PairDependence& from, const v1::ArrayReport& report, v1::SensorPair& to) {
  const bool fit = report.sensor_fits(static_cast<int>(from.pair.a)).fits() &&
                   report.sensor_fits(static_cast<int>(from.pair.b)).fits();
  to.set_withheld(!fit);
  to.set_dependent(fit && from.adjusted_p < kLevel);
}

void add_pairs(const ArrayFit& fit, const Measured& measured, const std::vector<Series>& sensors,
               double confidence, v1::ArrayReport& out) {
  for (const WaveletCovariance& one : measured) {
    if (one.samples != measured.front().samples) {
      out.add_notes(
          "The replicates differ in length: cross-covariances are tested on all, and shown on "
          "those as long as the first.");
      break;
    }
  }
  Measured alike;
  for (const WaveletCovariance& one : measured) {
    if (one.samples == measured.front().samples) alike.push_back(one);
  }
  WaveletCovariance mean = alike.front();
  mean.covariance = groups_of(alike).front().mean;
  const std::vector<Eigen::MatrixXd> model = covariance(fit.model, mean.scales);
  const Eigen::ArrayXd m = mean.scales.half_widths();
  for (const PairDependence& from : dependence(fit.model, measured)) {
    v1::SensorPair& to = *out.add_pairs();
    to.set_first(sensors[static_cast<std::size_t>(from.pair.a)].channel);
    to.set_second(sensors[static_cast<std::size_t>(from.pair.b)].channel);
    to.set_statistic(from.test.statistic);
    to.set_degrees_of_freedom(from.test.degrees_of_freedom);
    to.set_p_value(from.test.p_value);
    to.set_adjusted_p_value(from.adjusted_p);
    evaluate(from, out, to);
    add_scales(mean, alike.size(), model, from.pair, confidence, to);
    if (from.z.size() == 0) continue;
    Eigen::Index strongest = 0;
    from.z.abs().maxCoeff(&strongest);
    to.set_strongest_tau_s(2.0 * m(strongest) / out.rate_hz());
    to.set_correlation(from.correlation(strongest));
    to.set_z(from.z(strongest));
  }
}

Result<void> check_likelihood(const Model& written, const ArrayLayout& layout,
                              const std::vector<Series>& sensors) {
  if (!has_likelihood(expand(written, layout))) {
    return fail(
        "model: the likelihood of an array takes no ramp: leave DR out, or fit moments only");
  }
  for (const Signal& signal : sensors.front().replicates) {
    if (signal.size() < kFewestSamples)
      return fail(fmt::format("too short: a likelihood needs at least {} samples", kFewestSamples));
  }
  return {};
}

// The fit of the first `count` replicates.
ArrayFit fit_of(const std::vector<Series>& sensors, const ArraySetup& setup, std::size_t count,
                const ArraySeriesOptions& options, const Progress& progress) {
  ArrayFit out = fit_array(setup.model, setup.layout, std::span(setup.measured).first(count),
                           {options.weighting, options.cross, options.confidence}, progress);
  if (!options.efficient || progress.stopped()) return out;
  std::vector<CrossPower> powers;
  for (std::size_t k = 0; k < count; ++k) {
    std::vector<Signal> signals;
    for (const Series& one : sensors) signals.push_back(one.replicates[k]);
    powers.push_back(cross_power(samples_of(signals), signals.front().rate()));
  }
  return make_efficient(std::move(out), powers, options.confidence, progress);
}

// How much of each sensor's variance each term explains: its share of the sum of the model's
// wavelet variances, which for a stationary process is its share of the variance that these scales
// see.
void add_budgets(const ArrayFit& fit, const Model& written, const Scales& scales,
                 v1::ArrayReport& out) {
  const Eigen::ArrayXd m = scales.half_widths();
  for (int i = 0; i < out.sensors_size(); ++i) {
    v1::SensorBudget& budget = *out.add_budgets();
    budget.set_sensor(out.sensors(i));
    std::vector<double> sums(written.terms.size(), 0.0);
    double all = 0.0;
    for (const Latent& latent : fit.model.latents) {
      const double part = latent.power(i, i) * shape(latent.term.process, m).sum();
      sums[latent.written] += part;
      all += part;
    }
    for (std::size_t t = 0; t < sums.size() && all > 0.0; ++t) {
      v1::TermShare& share = *budget.add_terms();
      share.set_term(array_label(written, t));
      share.set_share(sums[t] / all);
    }
  }
}

std::string pairs_sentence(const v1::ArrayReport& report) {
  int dependent = 0;
  int withheld = 0;
  for (const v1::SensorPair& pair : report.pairs()) {
    dependent += pair.dependent() ? 1 : 0;
    withheld += pair.withheld() ? 1 : 0;
  }
  std::string misfits;
  for (const v1::SensorFit& one : report.sensor_fits()) {
    if (!one.fits()) misfits += (misfits.empty() ? "" : ", ") + one.sensor();
  }
  std::string out;
  if (!misfits.empty()) {
    out = fmt::format(
        "The model does not fit {}: whether {} of {} pairs share noise is not judged; add the "
        "terms "
        "that imunoise diagnose finds. ",
        misfits, withheld, report.pairs_size());
  }
  if (dependent > 0)
    return out +
           fmt::format("{} of {} pairs of sensors share noise.", dependent, report.pairs_size());
  if (withheld == report.pairs_size()) return out;
  if (report.correlation_found())
    return out +
           "Whether noise is shared is uncertain: a correlation of the model is not zero, but "
           "no pair as a whole shows shared noise.";
  return out + (withheld > 0 ? "The other pairs show no shared noise."
                             : "These recordings show no shared noise.");
}

std::string summary_of(const v1::ArrayReport& report, const Eigen::VectorXd& scale_weights) {
  std::string out = pairs_sentence(report);
  double predicted = 0.0;
  double measured = 0.0;
  bool held = true;
  for (int j = 0; j < report.virtual_sensor().scale_gains_size(); ++j) {
    const v1::ScaleGain& gain = report.virtual_sensor().scale_gains(j);
    predicted += scale_weights(j) * gain.predicted();
    measured += scale_weights(j) * gain.measured();
    held = held && gain.has_measured();
  }
  if (!out.empty() && out.back() != ' ') out += ' ';
  out += fmt::format(
      "The virtual sensor should have {} times the wavelet variance of the mean of the sensors, "
      "averaged over its scales",
      report::brief(predicted, 2));
  out += held ? fmt::format("; on held-out replicates it has {} times.", report::brief(measured, 2))
              : "; check this with more than one replicate.";
  if (report.virtual_sensor().plain_mean())
    out += " That is no gain: the plain mean of the sensors is used.";
  return out;
}

}  // namespace

Result<v1::ArrayReport> array_series(const std::vector<Series>& sensors,
                                     const ArraySeriesOptions& options, const Progress& progress) {
  const Result<ArraySetup> setup =
      array_setup(sensors, options.model ? *options.model : kDefaultArrayModel, options.groups,
                  options.per_octave, progress.part(0.0, 0.6));
  if (!setup) return tl::unexpected(setup.error());
  const Model& written = setup->model;
  const auto& measured = setup->measured;
  const std::size_t scales = measured.front().scales.size();
  const Result<Eigen::VectorXd> scale_weights = scale_weights_of(options.scales, scales);
  if (!scale_weights) return tl::unexpected(scale_weights.error());

  if (options.efficient) {
    if (auto able = check_likelihood(setup->model, setup->layout, sensors); !able)
      return tl::unexpected(able.error());
  }
  const auto fit_first = [&](std::size_t count, const Progress& part) {
    return fit_of(sensors, *setup, count, options, part);
  };
  const ArrayFit fit = fit_first(measured.size(), progress.part(0.6, 0.8));
  std::optional<ArrayFit> half;
  if (measured.size() > 1) half = fit_first((measured.size() + 1) / 2, progress.part(0.8, 1.0));
  if (progress.stopped()) return fail("stopped");

  v1::ArrayReport out;
  out.set_unit(std::string(si_symbol(sensors.front().replicates.front().quantity())));
  out.set_rate_hz(sensors.front().replicates.front().rate().value);
  for (const Series& one : sensors) out.add_sensors(one.channel);
  out.set_replicates(static_cast<std::uint32_t>(measured.size()));
  out.set_model(print(written));
  out.set_termination(std::string(describe(fit.termination)));
  out.set_objective(fit.objective);
  out.set_estimator(options.efficient ? likelihood_estimator("MGMWM") : "MGMWM");
  out.set_joint_weights(fit.joint_weights);
  for (v1::ArrayParameter& one : array_parameters(fit, written, sensors, options.confidence))
    *out.add_parameters() = std::move(one);
  add_budgets(fit, written, measured.front().scales, out);
  add_sensor_fits(fit, measured, out);
  add_pairs(fit, measured, sensors, options.confidence, out);
  add_virtual_sensor(fit, measured, *scale_weights, options, half, out);
  add_trade_offs(fit, measured, options, half, out);
  out.set_correlation_found(std::any_of(
      out.parameters().begin(), out.parameters().end(), [](const v1::ArrayParameter& one) {
        return one.has_correlation_lower() &&
               (one.correlation_lower() > 0.0 || one.correlation_upper() < 0.0);
      }));
  out.set_summary(summary_of(out, *scale_weights));
  if (!options.model) out.add_notes(default_model_note("was fitted", kDefaultArrayModel));
  if (options.rule == WeightRule::kUnitLength) {
    out.add_notes(
        fmt::format("These weights have Σ|c| = 1, as published: a common motion is multiplied by "
                    "{}. To measure motion, use --rule unit-gain.",
                    report::brief(out.virtual_sensor().gain())));
  }
  if (!fit.joint_weights) {
    out.add_notes(
        "There are too many moments to weight them jointly: each pair of sensors was "
        "weighted separately, which loses some precision.");
  }
  return out;
}

}  // namespace imunoise::study
