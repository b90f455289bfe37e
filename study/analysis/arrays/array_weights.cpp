#include "study/analysis/arrays/array_weights.h"

#include <fmt/format.h>

#include <algorithm>
#include <charconv>
#include <cmath>

#include "study/words/number.h"

namespace imunoise::study {
namespace {

constexpr std::size_t kPreset = 3;  // scales of "short" and "long"

std::string rule_name(WeightRule rule) {
  switch (rule) {
    case WeightRule::kUnitGain:
      return "unit-gain";
    case WeightRule::kNonnegative:
      return "non-negative";
    case WeightRule::kUnitLength:
      break;
  }
  return "unit-length";
}

// Covariance of the model's moments that the uncertainty of its parameters causes.
Eigen::MatrixXd moment_uncertainty(const ArrayFit& fit, const Scales& scales) {
  const Pairs pairs = all_pairs(fit.model.sensors);
  const Eigen::MatrixXd slope = parameter_slopes(fit, pairs, scales);
  return slope * fit.covariance * slope.transpose();
}

}  // namespace

Result<Eigen::VectorXd> scale_weights_of(const std::string& text, std::size_t count) {
  const auto n = static_cast<Eigen::Index>(count);
  const auto few = static_cast<Eigen::Index>(std::min(kPreset, count));
  Eigen::VectorXd out = Eigen::VectorXd::Zero(n);
  if (text == "all") {
    out.setOnes();
  } else if (text == "short") {
    out.head(few).setOnes();
  } else if (text == "long") {
    out.tail(few).setOnes();
  } else {
    const char* at = text.data();
    const char* const end = at + text.size();
    for (Eigen::Index j = 0; j < n; ++j) {
      const auto [stop, code] = std::from_chars(at, end, out(j));
      const bool last = j + 1 == n;
      if (code != std::errc() || !(out(j) >= 0.0) || !std::isfinite(out(j)) ||
          (last ? stop != end : stop == end || *stop != ',')) {
        return fail(fmt::format(
            "scales: '{}' is neither short, long nor all, nor {} weights of zero or more separated "
            "by commas, one for each scale",
            text, count));
      }
      at = stop + 1;
    }
  }
  if (!(out.sum() > 0.0)) return fail("scales: all weights are zero");
  return Eigen::VectorXd(out / out.sum());
}

VirtualSensor virtual_sensor_of(const ArrayFit& fit, const Scales& scales,
                                const Eigen::VectorXd& scale_weights, WeightRule rule) {
  const auto gammas = covariance(fit.model, scales);
  return best_virtual_sensor(weighted_covariance(gammas, scale_weights), rule);
}

namespace {

// Sums over the replicates that the weights were not made from.
struct HeldOutHalf {
  std::vector<Eigen::MatrixXd> covariance;  // a scale each
  std::vector<bool> prepared;               // whether a replicate is long enough for it
};

HeldOutHalf held_out_half(const Measured& measured, const Scales& scales, Eigen::Index sensors) {
  HeldOutHalf out{{scales.size(), Eigen::MatrixXd::Zero(sensors, sensors)},
                  std::vector<bool>(scales.size(), false)};
  for (std::size_t k = (measured.size() + 1) / 2; k < measured.size(); ++k) {
    // Scales of shorter replicates are the first of those of longer ones.
    const std::size_t common = std::min(scales.size(), measured[k].scales.size());
    for (std::size_t j = 0; j < common; ++j) {
      out.covariance[j] += measured[k].covariance[j];
      out.prepared[j] = true;
    }
  }
  return out;
}

bool noisier_than_mean(const HeldOutHalf& held, const VirtualSensor& sensor,
                       const Eigen::VectorXd& scale_weights) {
  const Eigen::MatrixXd weighted = weighted_covariance(held.covariance, scale_weights);
  return gain_over_mean({weighted}, sensor.weights)(0) > 1.0;
}

}  // namespace

namespace {

// `options` less their scales, which `scale_weights` stand for.
v1::VirtualSensor virtual_sensor_message(const ArrayFit& fit, const Measured& measured,
                                         const Eigen::VectorXd& scale_weights,
                                         const ArraySeriesOptions& options,
                                         const std::optional<ArrayFit>& half_fit,
                                         const v1::ArrayReport& out) {
  const Scales& scales = measured.front().scales;
  std::optional<VirtualSensor> half;
  if (half_fit) half = virtual_sensor_of(*half_fit, scales, scale_weights, options.rule);
  const auto gammas = covariance(fit.model, scales);
  const Eigen::MatrixXd weighted = weighted_covariance(gammas, scale_weights);
  VirtualSensor sensor = best_virtual_sensor(weighted, options.rule);
  v1::VirtualSensor to;
  to.set_rule(rule_name(options.rule));
  for (const double w : scale_weights) to.add_scale_weights(w);
  const Eigen::ArrayXd predicted = gain_over_mean(gammas, sensor.weights);
  const HeldOutHalf held = half ? held_out_half(measured, scales, weighted.rows()) : HeldOutHalf{};
  const Eigen::ArrayXd prepared = half ? gain_over_mean(held.covariance, half->weights) : predicted;
  for (std::size_t j = 0; j < scales.size(); ++j) {
    v1::ScaleGain& gain = *to.add_scale_gains();
    gain.set_tau_s(2.0 * static_cast<double>(scales[j]) / out.rate_hz());
    gain.set_predicted(predicted(static_cast<Eigen::Index>(j)));
    if (half && held.prepared[j]) gain.set_measured(prepared(static_cast<Eigen::Index>(j)));
  }
  // Weights of Σ|c| = 1 are asked for as published; others must be worth it.
  const bool free = options.rule != WeightRule::kUnitLength;
  if (half && free && noisier_than_mean(held, *half, scale_weights)) {
    to.set_plain_mean(true);
    sensor.weights.setConstant(1.0 / static_cast<double>(sensor.weights.size()));
    sensor.gain = 1.0;
  }
  Eigen::VectorXd errors;
  if (!to.plain_mean() && options.rule != WeightRule::kUnitLength) {
    errors = weight_covariance(sensor, weighted, scale_weights, moment_uncertainty(fit, scales))
                 .diagonal()
                 .cwiseMax(0.0)
                 .cwiseSqrt();
  }
  for (Eigen::Index i = 0; i < sensor.weights.size(); ++i) {
    v1::SensorWeight& weight = *to.add_weights();
    weight.set_sensor(out.sensors(static_cast<int>(i)));
    weight.set_weight(sensor.weights(i));
    if (errors.size() > 0 && std::isfinite(errors(i))) weight.set_standard_error(errors(i));
  }
  to.set_gain(sensor.gain);
  return to;
}

}  // namespace

void add_virtual_sensor(const ArrayFit& fit, const Measured& measured,
                        const Eigen::VectorXd& scale_weights, const ArraySeriesOptions& options,
                        const std::optional<ArrayFit>& half, v1::ArrayReport& out) {
  v1::VirtualSensor made = virtual_sensor_message(fit, measured, scale_weights, options, half, out);
  made.set_scales(options.scales);
  *out.mutable_virtual_sensor() = std::move(made);
}

void add_trade_offs(const ArrayFit& fit, const Measured& measured,
                    const ArraySeriesOptions& options, const std::optional<ArrayFit>& half,
                    v1::ArrayReport& out) {
  if (options.rule == WeightRule::kUnitLength) return;
  const auto count = static_cast<Eigen::Index>(measured.front().scales.size());
  for (Eigen::Index j = 0; j < count; ++j) {
    Eigen::VectorXd near = Eigen::VectorXd::Zero(count);
    near(j) = 1.0;
    if (j > 0) near(j - 1) = 0.5;
    if (j + 1 < count) near(j + 1) = 0.5;
    near /= near.sum();
    v1::VirtualSensor made = virtual_sensor_message(fit, measured, near, options, half, out);
    made.set_scales(report::brief(made.scale_gains(static_cast<int>(j)).tau_s()) + " s");
    *out.add_trade_offs() = std::move(made);
  }
}

}  // namespace imunoise::study
