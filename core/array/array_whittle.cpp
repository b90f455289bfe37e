#include "core/array/array_whittle.h"

#include <algorithm>
#include <cassert>
#include <cmath>
#include <limits>
#include <optional>

#include "core/array/array_inference.h"
#include "core/estimate/band_likelihood.h"
#include "core/estimate/fisher_scoring.h"
#include "core/estimate/searched_parameter.h"
#include "core/support/linear_algebra.h"

namespace imunoise {
namespace {

const Process& process_of(const ArrayModel& model, const ArrayParameter& parameter) {
  return model.latents[parameter.latent].term.process;
}

double get(const ArrayModel& model, const ArrayParameter& parameter) {
  return parameter.parameter == 0 ? value_of(model, parameter)
                                  : searched(process_of(model, parameter), parameter.parameter);
}

void set(ArrayModel& model, const ArrayParameter& parameter, double at) {
  if (parameter.parameter > 0) {
    set_searched(model.latents[parameter.latent].term.process, parameter.parameter, at);
  } else {
    set_value(model, parameter, at);
  }
}

SpectralDirection direction_of(const ArrayModel& model, const ArrayParameter& parameter,
                               const Frequencies& frequency) {
  Latent moved = model.latents[parameter.latent];
  if (parameter.parameter == 0 && moved.matrix()) {
    moved.power.setZero();
    moved.power(parameter.row, parameter.column) = 1.0;
    moved.power(parameter.column, parameter.row) = 1.0;
  } else if (parameter.parameter == 0) {
    moved.set_scalar(1.0);
  }
  return {searched_slope(moved.term.process, parameter.parameter, frequency), moved.power};
}

// Matrices as BandLikelihood takes them.
Eigen::ArrayXXd over_bands(const std::vector<Eigen::MatrixXd>& matrices, Eigen::Index channels) {
  Eigen::ArrayXXd out(static_cast<Eigen::Index>(matrices.size()), channels * channels);
  for (std::size_t b = 0; b < matrices.size(); ++b)
    out.row(static_cast<Eigen::Index>(b)) = matrices[b].reshaped().transpose();
  return out;
}

BandLikelihood likelihood_of(const ArrayModel& model, const CrossPower& measured) {
  Eigen::ArrayXXd expected =
      Eigen::ArrayXXd::Zero(measured.frequency.size(), model.sensors * model.sensors);
  for (const Latent& latent : model.latents) {
    expected += (spectrum(latent.term.process, measured.frequency).matrix() *
                 latent.power.reshaped().transpose())
                    .array();
  }
  return {measured.count, expected};
}

Curvature curvature_at(const ArrayModel& model, const std::vector<ArrayParameter>& parameters,
                       std::span<const CrossPower> replicates) {
  const auto n = static_cast<Eigen::Index>(parameters.size());
  Curvature out{Eigen::MatrixXd::Zero(n, n), Eigen::VectorXd::Zero(n)};
  for (const CrossPower& measured : replicates) {
    const BandLikelihood likelihood = likelihood_of(model, measured);
    std::vector<SpectralDirection> directions;
    for (const ArrayParameter& parameter : parameters)
      directions.push_back(direction_of(model, parameter, measured.frequency));
    const Eigen::MatrixXd slopes = likelihood.slopes(directions);
    out.information += slopes.transpose() * slopes;
    out.score += slopes.transpose() * likelihood.excess(over_bands(measured.power, model.sensors));
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
    out.curvature = [this](const Eigen::VectorXd& x, Asked) {
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
ParameterCovariance bound(const ArrayFit& fit, const ArrayModel& scatter,
                          std::span<const CrossPower> replicates) {
  const Curvature curvature = curvature_at(scatter, fit.parameters, replicates);
  Eigen::VectorXd per_value(curvature.score.size());
  for (std::size_t i = 0; i < fit.parameters.size(); ++i) {
    const ArrayParameter& parameter = fit.parameters[i];
    per_value(static_cast<Eigen::Index>(i)) =
        1.0 / searched_scale(process_of(scatter, parameter), parameter.parameter);
  }
  return inverse_information(per_value.asDiagonal() * curvature.information *
                             per_value.asDiagonal());
}

// The sensors of an array resemble each other: where one lost a process that the others have, the
// shape and the power of theirs are a place to begin. Nothing where none did.
std::optional<ArrayModel> with_lost_found(const ArrayModel& model) {
  constexpr double kLost = 0.05;  // of the others' power
  std::optional<ArrayModel> out;
  for (const Latent& one : model.latents) {
    std::vector<std::size_t> alike;
    for (std::size_t l = 0; l < model.latents.size(); ++l) {
      const Latent& other = model.latents[l];
      if (other.written == one.written && other.sensors.size() == 1) alike.push_back(l);
    }
    if (one.sensors.size() != 1 || alike.size() < 2) continue;
    const auto power = [&](std::size_t l) { return model.latents[l].scalar(); };
    std::sort(alike.begin(), alike.end(),
              [&](std::size_t a, std::size_t b) { return power(a) < power(b); });
    const Latent& usual = model.latents[alike[alike.size() / 2]];
    if (!(one.scalar() < kLost * usual.scalar())) continue;
    if (!out) out = model;
    Latent& found = out->latents[static_cast<std::size_t>(&one - model.latents.data())];
    found.term.process = usual.term.process;
    found.set_scalar(usual.scalar());
  }
  return out;
}

}  // namespace

bool has_likelihood(const ArrayModel& model) {
  return std::none_of(model.latents.begin(), model.latents.end(), [](const Latent& latent) {
    return std::holds_alternative<RateRamp>(latent.term.process);
  });
}

double whittle_objective(const ArrayModel& model, std::span<const CrossPower> replicates) {
  double out = 0.0;
  for (const CrossPower& measured : replicates)
    out += likelihood_of(model, measured).objective(over_bands(measured.power, model.sensors));
  return out;
}

ArrayFit make_efficient(ArrayFit fit, std::span<const CrossPower> replicates, double confidence,
                        const Progress& progress) {
  assert(has_likelihood(fit.model));
  const ArrayLikelihood likelihood(fit.model, replicates);
  Scored found = maximise(likelihood.likelihood(), likelihood.start(), progress);
  if (const auto other = with_lost_found(likelihood.model_at(found.at))) {
    const Eigen::VectorXd start = ArrayLikelihood(*other, replicates).start();
    Scored again = maximise(likelihood.likelihood(), start, progress);
    if (again.objective < found.objective) found = std::move(again);
  }
  fit.model = sorted(likelihood.model_at(found.at));
  fit.termination = found.termination;
  double samples = 0.0;
  for (const CrossPower& one : replicates) samples += one.count.sum();
  fill_estimates(fit, confidence, samples,
                 [&](const ArrayModel& scatter) { return bound(fit, scatter, replicates); });
  return fit;
}

ArrayModel one_step(const ArrayModel& model, std::span<const CrossPower> replicates) {
  const ArrayLikelihood likelihood(model, replicates);
  return likelihood.model_at(fisher_scoring(likelihood.likelihood(), likelihood.start(), {}, 1).at);
}

}  // namespace imunoise
