#include "study/analysis/array_series.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "core/array/array_blocks.h"
#include "core/array/dependence.h"
#include "core/support/distributions.h"
#include "study/analysis/array_setup.h"
#include "study/analysis/array_weights.h"
#include "study/analysis/prepare.h"
#include "study/analysis/vocabulary.h"

namespace imunoise::study {
namespace {

constexpr double kLevel = 0.05;

// "RW[corr]", "AR1 (2)".
std::string array_label(const Model& written, std::size_t term) {
  const std::string_view shared = word_of(written.terms[term].sharing);
  return label_of(written, term) + (shared.empty() ? "" : fmt::format("[{}]", shared));
}

// The correlation of two sensors in a term with a matrix of powers, with its interval (Fisher's z).
void set_correlation(const ArrayFit& fit, std::size_t index, double confidence,
                     v1::ArrayParameter& to) {
  const ArrayParameter& from = fit.parameters[index];
  const Eigen::MatrixXd& power = fit.model.latents[from.latent].power;
  const double a = power(from.row, from.row);
  const double b = power(from.column, from.column);
  if (!(a > 0.0 && b > 0.0)) return;
  const double r = std::clamp(from.estimate.value / std::sqrt(a * b), -1.0, 1.0);
  to.set_correlation(r);
  const auto p = static_cast<Eigen::Index>(fit.parameters.size());
  Eigen::VectorXd slope = Eigen::VectorXd::Zero(p);
  for (Eigen::Index i = 0; i < p; ++i) {
    const ArrayParameter& other = fit.parameters[static_cast<std::size_t>(i)];
    if (other.latent != from.latent || other.parameter != 0) continue;
    if (other.row == from.row && other.column == from.row) slope(i) = -0.5 * r / a;
    if (other.row == from.column && other.column == from.column) slope(i) = -0.5 * r / b;
  }
  slope(static_cast<Eigen::Index>(index)) = 1.0 / std::sqrt(a * b);
  const double error = std::sqrt(std::max(0.0, slope.dot(fit.covariance * slope)));
  if (!(std::abs(r) < 1.0 - 1e-9) || !std::isfinite(error)) return;
  const double reach = normal_quantile(0.5 + 0.5 * confidence) * error / (1.0 - r * r);
  to.set_correlation_lower(std::tanh(std::atanh(r) - reach));
  to.set_correlation_upper(std::tanh(std::atanh(r) + reach));
}

void add_parameters(const ArrayFit& fit, const Model& written, const std::vector<Series>& sensors,
                    double confidence, v1::ArrayReport& out) {
  const Quantity quantity = sensors.front().replicates.front().quantity();
  for (std::size_t i = 0; i < fit.parameters.size(); ++i) {
    const ArrayParameter& from = fit.parameters[i];
    const Latent& latent = fit.model.latents[from.latent];
    const ParameterInfo about = parameters(latent.term.process)[from.parameter];
    v1::ArrayParameter& to = *out.add_parameters();
    to.set_term(array_label(written, latent.written));
    to.set_parameter(about.name);
    to.set_unit(unit_of(about.dimension, quantity));
    if (latent.matrix() && from.parameter == 0) {
      to.add_sensors(sensors[static_cast<std::size_t>(from.row)].channel);
      if (from.row != from.column) {
        to.add_sensors(sensors[static_cast<std::size_t>(from.column)].channel);
      }
    } else {
      for (const Eigen::Index s : latent.sensors) {
        to.add_sensors(sensors[static_cast<std::size_t>(s)].channel);
      }
    }
    to.set_value(from.estimate.value);
    if (std::isfinite(from.estimate.standard_error)) {
      to.set_standard_error(from.estimate.standard_error);
      to.set_lower(from.estimate.lower);
      to.set_upper(from.estimate.upper);
    }
    if (from.row != from.column) set_correlation(fit, i, confidence, to);
  }
}

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

void add_pairs(const ArrayFit& fit, const Measured& measured, const std::vector<Series>& sensors,
               double confidence, v1::ArrayReport& out) {
  for (const WaveletCovariance& one : measured) {
    if (one.samples != measured.front().samples) {
      out.add_notes(
          "The replicates differ in length: cross-covariances are shown and tested on those as "
          "long "
          "as the first.");
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
  for (const PairDependence& from : dependence(fit.model, alike)) {
    v1::SensorPair& to = *out.add_pairs();
    to.set_first(sensors[static_cast<std::size_t>(from.pair.a)].channel);
    to.set_second(sensors[static_cast<std::size_t>(from.pair.b)].channel);
    to.set_statistic(from.test.statistic);
    to.set_degrees_of_freedom(from.test.degrees_of_freedom);
    to.set_p_value(from.test.p_value);
    to.set_adjusted_p_value(from.adjusted_p);
    to.set_dependent(from.adjusted_p < kLevel);
    add_scales(mean, alike.size(), model, from.pair, confidence, to);
    if (from.z.size() == 0) continue;
    Eigen::Index strongest = 0;
    from.z.abs().maxCoeff(&strongest);
    to.set_strongest_tau_s(2.0 * m(strongest) / out.rate_hz());
    to.set_correlation(from.correlation(strongest));
    to.set_z(from.z(strongest));
  }
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

std::string summary_of(const v1::ArrayReport& report, const Eigen::VectorXd& scale_weights) {
  int dependent = 0;
  for (const v1::SensorPair& pair : report.pairs()) dependent += pair.dependent() ? 1 : 0;
  std::string out = dependent == 0 ? "No two sensors share noise that these recordings can show."
                                   : fmt::format("{} of {} pairs of sensors share noise.",
                                                 dependent, report.pairs_size());
  double predicted = 0.0;
  double measured = 0.0;
  bool held = true;
  for (int j = 0; j < report.virtual_sensor().scale_gains_size(); ++j) {
    const v1::ScaleGain& gain = report.virtual_sensor().scale_gains(j);
    predicted += scale_weights(j) * gain.predicted();
    measured += scale_weights(j) * gain.measured();
    held = held && gain.has_measured();
  }
  out += fmt::format(
      " The virtual sensor should have {:.2g} times the wavelet variance of the sensors' mean, "
      "averaged over the scales it was made for",
      predicted);
  out += held ? fmt::format(
                    "; on replicates that its weights were not made from it has {:.2g} "
                    "times.",
                    measured)
              : "; with more than one replicate that could be checked.";
  return out;
}

}  // namespace

Result<v1::ArrayReport> array_series(const std::vector<Series>& sensors,
                                     const ArraySeriesOptions& options, const Progress& progress) {
  const Result<ArraySetup> setup =
      array_setup(sensors, options.model ? *options.model : kDefaultArrayModel, options.groups,
                  options.per_octave, progress.part(0.0, 0.6));
  if (!setup) return tl::unexpected(setup.error());
  const auto& [written, layout, measured] = *setup;
  const std::size_t scales = measured.front().scales.size();
  const Result<Eigen::VectorXd> scale_weights = scale_weights_of(options.scales, scales);
  if (!scale_weights) return tl::unexpected(scale_weights.error());

  const ArrayOptions how{options.weighting, options.cross, options.confidence};
  const ArrayFit fit = fit_array(written, layout, measured, how, progress.part(0.6, 0.8));
  std::optional<VirtualSensor> half;
  const bool alike = std::all_of(measured.begin(), measured.end(), [&](const auto& one) {
    return one.scales == measured.front().scales;
  });
  if (measured.size() > 1 && alike) {
    const auto training = std::span(measured).first((measured.size() + 1) / 2);
    half = virtual_sensor_of(fit_array(written, layout, training, how, progress.part(0.8, 1.0)),
                             measured.front().scales, *scale_weights, options.rule);
  }
  if (progress.stopped()) return fail("stopped");

  v1::ArrayReport out;
  out.set_unit(std::string(si_symbol(sensors.front().replicates.front().quantity())));
  out.set_rate_hz(sensors.front().replicates.front().rate().value);
  for (const Series& one : sensors) out.add_sensors(one.channel);
  out.set_replicates(static_cast<std::uint32_t>(measured.size()));
  out.set_model(print(written));
  out.set_termination(std::string(describe(fit.termination)));
  out.set_objective(fit.objective);
  out.set_joint_weights(fit.joint_weights);
  add_parameters(fit, written, sensors, options.confidence, out);
  add_budgets(fit, written, measured.front().scales, out);
  add_pairs(fit, measured, sensors, options.confidence, out);
  add_virtual_sensor(fit, measured, *scale_weights, options, half, out);
  out.set_summary(summary_of(out, *scale_weights));
  if (!options.model) out.add_notes(default_model_note("was fitted", kDefaultArrayModel));
  if (options.rule == WeightRule::kUnitLength) {
    out.add_notes(fmt::format(
        "These weights have Σ|c| = 1, as published: a motion that all sensors see is multiplied by "
        "{:.3g}. For a sensor that measures, take unit-gain.",
        out.virtual_sensor().gain()));
  }
  if (!fit.joint_weights) {
    out.add_notes(
        "There are too many moments to weight them jointly: each pair of sensors was "
        "weighted by itself, which loses some precision.");
  }
  return out;
}

}  // namespace imunoise::study
