#include "core/estimate/whittle.h"

#include <algorithm>
#include <cmath>
#include <limits>

#include "core/estimate/fisher_scoring.h"
#include "core/process/parameter_scale.h"

namespace imunoise {
namespace {

// ω² of the model's ramps: one of them is enough, several are one.
double ramp_power(const Model& model) {
  double out = 0.0;
  for (const Term& term : model.terms) {
    if (const auto* drift = std::get_if<Drift>(&term.process)) out += drift->omega2;
  }
  return out;
}

// Mean square of the coefficients less the ramp, which runs the way that fits better.
Eigen::ArrayXd residual_power(const BandedPower& bands, const Eigen::ArrayXd& spectrum,
                              double ramp2) {
  if (ramp2 == 0.0) return bands.power;
  const double agreement = (bands.count * bands.ramp_cross / spectrum).sum();
  const double slope = std::copysign(std::sqrt(ramp2), agreement);
  return bands.power - 2.0 * slope * bands.ramp_cross + ramp2 * bands.ramp_power;
}

// A free parameter, and the scale that the search moves it on: powers as they are, shapes on
// theirs.
struct Coordinate {
  std::size_t term;
  std::size_t parameter;
  ParameterInfo info;
  ParameterScale scale() const { return {info, parameter}; }
  bool power() const { return parameter == 0; }
};

double get(const Model& model, const Coordinate& c) {
  const double value = values(model.terms[c.term].process)[c.parameter];
  return c.power() ? value : c.scale().to_scale(value);
}

void set(Model& model, const Coordinate& c, double at) {
  Process& process = model.terms[c.term].process;
  std::vector<double> v = values(process);
  v[c.parameter] = c.power() ? at : std::clamp(c.scale().to_value(at), c.info.lower, c.info.upper);
  set_values(process, v);
}

// The free parameters but those of ramps, which do not show in the spectrum.
std::vector<Coordinate> coordinates_of(const Model& model) {
  std::vector<Coordinate> out;
  for (std::size_t t = 0; t < model.terms.size(); ++t) {
    const Term& term = model.terms[t];
    if (std::holds_alternative<Drift>(term.process)) continue;
    const std::vector<ParameterInfo> about = parameters(term.process);
    for (std::size_t p = 0; p < about.size(); ++p) {
      if (!term.given[p]) out.push_back({t, p, about[p]});
    }
  }
  return out;
}

// d spectrum / d coordinate.
Eigen::ArrayXd slope_over(const Model& model, const Coordinate& c,
                          const Eigen::ArrayXd& frequency) {
  constexpr double kStep = 1e-4;
  Model moved{{model.terms[c.term]}};
  const Coordinate there{0, c.parameter, c.info};
  if (c.power()) {
    set(moved, there, 1.0);
    return spectrum(moved, frequency);
  }
  const double at = get(moved, there);
  const auto side = [&](double to) {
    set(moved, there, to);
    return spectrum(moved, frequency);
  };
  return (side(at + kStep) - side(at - kStep)) / (2.0 * kStep);
}

// The ramp's power at its best: the replicates' slopes, each with its sign taken off, averaged.
void fit_ramp(Model& model, std::span<const BandedPower> replicates) {
  const auto ramp = std::find_if(model.terms.begin(), model.terms.end(), [](const Term& term) {
    return std::holds_alternative<Drift>(term.process) && !term.given[0];
  });
  if (ramp == model.terms.end()) return;
  double cross = 0.0;
  double power = 0.0;
  for (const BandedPower& bands : replicates) {
    const Eigen::ArrayXd weight = bands.count / spectrum(model, bands.frequency);
    cross += std::abs((weight * bands.ramp_cross).sum());
    power += (weight * bands.ramp_power).sum();
  }
  if (!(power > 0.0) || !std::isfinite(cross / power)) return;
  set_values(ramp->process, std::vector<double>{(cross / power) * (cross / power)});
}

Curvature curvature_at(const Model& model, const std::vector<Coordinate>& coordinates,
                       std::span<const BandedPower> replicates) {
  const auto n = static_cast<Eigen::Index>(coordinates.size());
  Curvature out{Eigen::MatrixXd::Zero(n, n), Eigen::VectorXd::Zero(n)};
  for (const BandedPower& bands : replicates) {
    const Eigen::ArrayXd s = spectrum(model, bands.frequency);
    const Eigen::ArrayXd root = (0.5 * bands.count).sqrt() / s;
    Eigen::MatrixXd slopes(bands.frequency.size(), n);
    for (Eigen::Index i = 0; i < n; ++i) {
      slopes.col(i) =
          (root * slope_over(model, coordinates[static_cast<std::size_t>(i)], bands.frequency))
              .matrix();
    }
    const Eigen::ArrayXd excess = residual_power(bands, s, ramp_power(model)) - s;
    out.information += slopes.transpose() * slopes;
    out.score += slopes.transpose() * (root * excess).matrix();
  }
  return out;
}

// Calls visit(coordinate, place in `columns`) for each column of the model that is asked for.
template <class Visit>
void for_each_column(const Model& model, const std::vector<Eigen::Index>& columns,
                     const Visit& visit) {
  Eigen::Index column = 0;
  for (std::size_t t = 0; t < model.terms.size(); ++t) {
    const std::vector<ParameterInfo> about = parameters(model.terms[t].process);
    for (std::size_t p = 0; p < about.size(); ++p, ++column) {
      const auto place = std::find(columns.begin(), columns.end(), column);
      if (place != columns.end()) visit(Coordinate{t, p, about[p]}, place - columns.begin());
    }
  }
}

}  // namespace

double whittle_objective(const Model& model, std::span<const BandedPower> replicates) {
  double out = 0.0;
  const double ramp2 = ramp_power(model);
  for (const BandedPower& bands : replicates) {
    const Eigen::ArrayXd s = spectrum(model, bands.frequency);
    if (!(s.minCoeff() > 0.0)) return std::numeric_limits<double>::infinity();
    out += (0.5 * bands.count * (s.log() + residual_power(bands, s, ramp2) / s)).sum();
  }
  return out;
}

Eigen::MatrixXd whittle_slopes(const Model& model, const BandedPower& bands,
                               const std::vector<Eigen::Index>& columns) {
  const Eigen::ArrayXd root = (0.5 * bands.count).sqrt() / spectrum(model, bands.frequency);
  Eigen::MatrixXd out =
      Eigen::MatrixXd::Zero(bands.frequency.size(), static_cast<Eigen::Index>(columns.size()));
  for_each_column(model, columns, [&](const Coordinate& c, Eigen::Index place) {
    if (std::holds_alternative<Drift>(model.terms[c.term].process)) return;
    const double value = values(model.terms[c.term].process)[c.parameter];
    const double per_value = c.power() ? 1.0 : 1.0 / c.scale().slope(value);
    out.col(place) = (root * slope_over(model, c, bands.frequency) * per_value).matrix();
  });
  return out;
}

Eigen::MatrixXd whittle_information(const Model& model, std::span<const BandedPower> replicates,
                                    const std::vector<Eigen::Index>& columns) {
  const auto n = static_cast<Eigen::Index>(columns.size());
  Eigen::MatrixXd out = Eigen::MatrixXd::Zero(n, n);
  for (const BandedPower& bands : replicates) {
    const Eigen::MatrixXd slopes = whittle_slopes(model, bands, columns);
    out += slopes.transpose() * slopes;
    const Eigen::ArrayXd s = spectrum(model, bands.frequency);
    for_each_column(model, columns, [&](const Coordinate& c, Eigen::Index place) {
      const auto* drift = std::get_if<Drift>(&model.terms[c.term].process);
      if (drift == nullptr) return;
      out(place, place) += (bands.count * bands.ramp_power / s).sum() / (4.0 * drift->omega2);
    });
  }
  return out;
}

WhittleEstimate whittle(const Model& start, std::span<const BandedPower> replicates,
                        const Progress& progress) {
  const std::vector<Coordinate> coordinates = coordinates_of(start);
  Eigen::VectorXd at(static_cast<Eigen::Index>(coordinates.size()));
  Likelihood likelihood;
  for (std::size_t i = 0; i < coordinates.size(); ++i) {
    at(static_cast<Eigen::Index>(i)) = get(start, coordinates[i]);
    likelihood.cones.push_back(coordinates[i].power() ? 1 : Likelihood::kFree);
  }
  const auto model_at = [&](const Eigen::VectorXd& x) {
    Model out = start;
    for (std::size_t i = 0; i < coordinates.size(); ++i)
      set(out, coordinates[i], x(static_cast<Eigen::Index>(i)));
    fit_ramp(out, replicates);
    return out;
  };
  likelihood.objective = [&](const Eigen::VectorXd& x) {
    return whittle_objective(model_at(x), replicates);
  };
  likelihood.curvature = [&](const Eigen::VectorXd& x) {
    return curvature_at(model_at(x), coordinates, replicates);
  };
  const Scored scored = maximise(likelihood, at, progress);
  return {sorted(model_at(scored.at)), scored.objective, scored.termination};
}

}  // namespace imunoise
