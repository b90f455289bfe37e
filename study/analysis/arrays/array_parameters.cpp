#include "study/analysis/arrays/array_parameters.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "core/support/distributions.h"
#include "study/analysis/vocabulary.h"

namespace imunoise::study {
namespace {

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

}  // namespace

std::string array_label(const Model& written, std::size_t term) {
  const std::string_view shared = word_of(written.terms[term].sharing);
  return label_of(written, term) + (shared.empty() ? "" : fmt::format("[{}]", shared));
}

std::vector<v1::ArrayParameter> array_parameters(const ArrayFit& fit, const Model& written,
                                                 const std::vector<Series>& sensors,
                                                 double confidence) {
  std::vector<v1::ArrayParameter> out;
  const Quantity quantity = sensors.front().replicates.front().quantity();
  for (std::size_t i = 0; i < fit.parameters.size(); ++i) {
    const ArrayParameter& from = fit.parameters[i];
    const Latent& latent = fit.model.latents[from.latent];
    const ParameterInfo about = parameters(latent.term.process)[from.parameter];
    v1::ArrayParameter& to = out.emplace_back();
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
  return out;
}

}  // namespace imunoise::study
