#include "core/array/array_whittle.h"

#include <algorithm>
#include <cassert>
#include <cmath>
#include <limits>

#include "core/array/array_inference.h"
#include "core/array/cross_spectra.h"
#include "core/estimate/fisher_scoring.h"
#include "core/process/parameter_scale.h"
#include "core/support/linear_algebra.h"

namespace imunoise {
namespace {

ParameterScale scale_of(const ArrayModel& model, const ArrayParameter& parameter) {
  const Process& process = model.latents[parameter.latent].term.process;
  return {parameters(process)[parameter.parameter], parameter.parameter};
}

double get(const ArrayModel& model, const ArrayParameter& parameter) {
  const double value = value_of(model, parameter);
  return parameter.parameter == 0 ? value : scale_of(model, parameter).to_scale(value);
}

void set(ArrayModel& model, const ArrayParameter& parameter, double at) {
  Latent& latent = model.latents[parameter.latent];
  if (parameter.parameter == 0) {
    if (latent.matrix()) {
      latent.power(parameter.row, parameter.column) = at;
      latent.power(parameter.column, parameter.row) = at;
    } else {
      latent.set_scalar(at);
    }
    return;
  }
  const ParameterInfo about = parameters(latent.term.process)[parameter.parameter];
  std::vector<double> v = values(latent.term.process);
  v[parameter.parameter] =
      std::clamp(scale_of(model, parameter).to_value(at), about.lower, about.upper);
  set_values(latent.term.process, v);
}

// How the cross spectra move with a parameter on its search scale: one spectrum times one matrix.
struct Direction {
  Eigen::ArrayXd spectrum;
  Eigen::MatrixXd matrix;
};

Direction direction_of(const ArrayModel& model, const ArrayParameter& parameter,
                       const Eigen::ArrayXd& frequency) {
  constexpr double kStep = 1e-4;
  const Latent& latent = model.latents[parameter.latent];
  if (parameter.parameter > 0) {
    const double at = get(model, parameter);
    const auto side = [&](double to) {
      ArrayModel moved = model;
      set(moved, parameter, to);
      return spectrum(moved.latents[parameter.latent].term.process, frequency);
    };
    return {(side(at + kStep) - side(at - kStep)) / (2.0 * kStep), latent.power};
  }
  Latent unit = latent;
  if (latent.matrix()) {
    unit.power.setZero();
    unit.power(parameter.row, parameter.column) = 1.0;
    unit.power(parameter.column, parameter.row) = 1.0;
  } else {
    unit.set_scalar(1.0);
  }
  return {spectrum(latent.term.process, frequency), unit.power};
}

Curvature curvature_at(const ArrayModel& model, const std::vector<ArrayParameter>& parameters,
                       std::span<const CrossPower> replicates) {
  const auto n = static_cast<Eigen::Index>(parameters.size());
  const Eigen::Index entries = model.sensors * model.sensors;
  Curvature out{Eigen::MatrixXd::Zero(n, n), Eigen::VectorXd::Zero(n)};
  for (const CrossPower& measured : replicates) {
    std::vector<Direction> directions;
    for (const ArrayParameter& parameter : parameters)
      directions.push_back(direction_of(model, parameter, measured.frequency));
    const CrossSpectra spectra(model, measured.frequency);
    Eigen::MatrixXd left(entries, n);
    Eigen::MatrixXd right(entries, n);
    for (Eigen::Index b = 0; b < measured.frequency.size(); ++b) {
      const Eigen::MatrixXd expected = spectra(b);
      const Eigen::MatrixXd inverse = positive_inverse(expected).matrix;
      const Eigen::MatrixXd excess =
          inverse * (measured.power[static_cast<std::size_t>(b)] - expected) * inverse;
      for (Eigen::Index i = 0; i < n; ++i) {
        const Direction& direction = directions[static_cast<std::size_t>(i)];
        const Eigen::MatrixXd moved = direction.spectrum(b) * (inverse * direction.matrix);
        left.col(i) = moved.reshaped();
        right.col(i) = moved.transpose().reshaped();
        out.score(i) += 0.5 * measured.count(b) * direction.spectrum(b) *
                        excess.cwiseProduct(direction.matrix).sum();
      }
      // tr(Σ⁻¹ D_i Σ⁻¹ D_j)
      out.information.noalias() += 0.5 * measured.count(b) * (left.transpose() * right);
    }
  }
  return out;
}

// The likelihood over an array's parameters, and the model at a point of it.
class ArrayLikelihood {
 public:
  ArrayLikelihood(const ArrayModel& open, std::span<const CrossPower> replicates)
      : open_(open), parameters_(parameters_of(open)), replicates_(replicates) {}

  Eigen::VectorXd start() const {
    Eigen::VectorXd out(static_cast<Eigen::Index>(parameters_.size()));
    for (std::size_t i = 0; i < parameters_.size(); ++i)
      out(static_cast<Eigen::Index>(i)) = get(open_, parameters_[i]);
    return out;
  }
  ArrayModel model_at(const Eigen::VectorXd& x) const {
    ArrayModel out = open_;
    for (std::size_t i = 0; i < parameters_.size(); ++i)
      set(out, parameters_[i], x(static_cast<Eigen::Index>(i)));
    return out;
  }
  Likelihood likelihood() const {
    Likelihood out;
    for (const ArrayParameter& parameter : parameters_) {
      const Latent& latent = open_.latents[parameter.latent];
      if (parameter.parameter > 0) {
        out.cones.push_back(Likelihood::kFree);
      } else if (!latent.matrix()) {
        out.cones.push_back(1);
      } else if (parameter.row == 0 && parameter.column == 0) {
        out.cones.push_back(open_.sensors);  // its other entries follow, as they are packed
      }
    }
    out.objective = [this](const Eigen::VectorXd& x) {
      return whittle_objective(model_at(x), replicates_);
    };
    out.curvature = [this](const Eigen::VectorXd& x) {
      return curvature_at(model_at(x), parameters_, replicates_);
    };
    return out;
  }

 private:
  const ArrayModel& open_;
  std::vector<ArrayParameter> parameters_;
  std::span<const CrossPower> replicates_;
};

// Inverse information of the parameters as they are (not on their search scale), were the noise
// that of `scatter`.
ArrayCovariance bound(const ArrayFit& fit, const ArrayModel& scatter,
                      std::span<const CrossPower> replicates) {
  const Curvature curvature = curvature_at(scatter, fit.parameters, replicates);
  Eigen::VectorXd per_value(curvature.score.size());
  for (std::size_t i = 0; i < fit.parameters.size(); ++i) {
    const ArrayParameter& parameter = fit.parameters[i];
    per_value(static_cast<Eigen::Index>(i)) =
        parameter.parameter == 0
            ? 1.0
            : 1.0 / scale_of(scatter, parameter).slope(value_of(scatter, parameter));
  }
  const PseudoInverse inverse =
      pseudo_inverse(per_value.asDiagonal() * curvature.information * per_value.asDiagonal());
  return {inverse.matrix, inverse.null_share};
}

}  // namespace

bool has_likelihood(const ArrayModel& model) {
  return std::none_of(model.latents.begin(), model.latents.end(), [](const Latent& latent) {
    return std::holds_alternative<Drift>(latent.term.process);
  });
}

double whittle_objective(const ArrayModel& model, std::span<const CrossPower> replicates) {
  double out = 0.0;
  for (const CrossPower& measured : replicates) {
    const CrossSpectra spectra(model, measured.frequency);
    for (Eigen::Index b = 0; b < measured.frequency.size(); ++b) {
      const PositiveInverse inverse = positive_inverse(spectra(b));
      if (!std::isfinite(inverse.log_determinant)) return std::numeric_limits<double>::infinity();
      out += 0.5 * measured.count(b) *
             (inverse.log_determinant +
              inverse.matrix.cwiseProduct(measured.power[static_cast<std::size_t>(b)]).sum());
    }
  }
  return out;
}

ArrayFit make_efficient(ArrayFit fit, std::span<const CrossPower> replicates, double confidence,
                        const Progress& progress) {
  assert(has_likelihood(fit.model));
  const ArrayLikelihood likelihood(fit.model, replicates);
  const Scored found = maximise(likelihood.likelihood(), likelihood.start(), progress);
  fit.model = sorted(likelihood.model_at(found.at));
  fit.termination = found.termination;
  fill_estimates(fit, confidence,
                 [&](const ArrayModel& scatter) { return bound(fit, scatter, replicates); });
  return fit;
}

ArrayModel one_step(const ArrayModel& model, std::span<const CrossPower> replicates) {
  const ArrayLikelihood likelihood(model, replicates);
  return likelihood.model_at(fisher_scoring(likelihood.likelihood(), likelihood.start(), {}, 1).at);
}

}  // namespace imunoise
