#include "core/estimate/whittle.h"

#include <algorithm>
#include <cmath>

#include "core/estimate/band_likelihood.h"
#include "core/estimate/fisher_scoring.h"
#include "core/estimate/searched_parameter.h"
#include "core/estimate/sharp_peaks.h"
#include "core/estimate/spectral_expansion.h"

namespace imunoise {
namespace {

// ω² of the model's ramps: one of them is enough, several are one.
double ramp_power(const Model& model) {
  double out = 0.0;
  for (const Term& term : model.terms) {
    if (const auto* drift = std::get_if<RateRamp>(&term.process)) out += drift->omega2;
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

const Process& process_of(const Model& model, const ParameterPlace& place) {
  return model.terms[place.term].process;
}

bool is_ramp(const Process& process) { return std::holds_alternative<RateRamp>(process); }

// The free parameters but those of ramps, which do not show in the spectrum.
std::vector<ParameterPlace> coordinates_of(const Model& model) {
  std::vector<ParameterPlace> out = parameter_places(model);
  std::erase_if(out, [&](const ParameterPlace& place) {
    return model.terms[place.term].given[place.parameter] || is_ramp(process_of(model, place));
  });
  return out;
}

SpectralDirection direction_of(const Model& model, const ParameterPlace& c,
                               const Frequencies& frequency) {
  return {searched_slope(process_of(model, c), c.parameter, frequency),
          Eigen::MatrixXd::Ones(1, 1)};
}

// The ramp's power at its best: the replicates' slopes, each with its sign taken off, averaged.
void fit_ramp(Model& model, std::span<const BandedPower> replicates) {
  const auto ramp = std::find_if(model.terms.begin(), model.terms.end(), [](const Term& term) {
    return std::holds_alternative<RateRamp>(term.process) && !term.given[0];
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

// The expansions of all processes with coordinates, in the order of these.
std::vector<SpectralExpansion> expansions_of(const Model& model,
                                             const std::vector<ParameterPlace>& coordinates,
                                             const Frequencies& frequency,
                                             SpectralExpansion::Order order) {
  std::vector<SpectralExpansion> out;
  std::vector<std::size_t> parameters;
  for (std::size_t i = 0; i < coordinates.size(); ++i) {
    parameters.push_back(coordinates[i].parameter);
    const bool last = i + 1 == coordinates.size() || coordinates[i + 1].term != coordinates[i].term;
    if (!last) continue;
    out.emplace_back(process_of(model, coordinates[i]), parameters, frequency, order);
    parameters.clear();
  }
  return out;
}

// Observed and Fisher's information. Of -log likelihood Σ n/2 (log S + C/S), and e = C/S - 1, the
// second derivatives are Σ n/2 ((1 + 2e) S_i S_j / S² - e S_ij / S); Fisher's information is their
// mean under a true model, e = 0. S_ij is zero for parameters of different processes.
Curvature curvature_at(const Model& model, const std::vector<ParameterPlace>& coordinates,
                       std::span<const BandedPower> replicates, Asked asked) {
  const bool observed = asked == Asked::kObserved;
  const auto order =
      observed ? SpectralExpansion::Order::kSecond : SpectralExpansion::Order::kFirst;
  const auto n = static_cast<Eigen::Index>(coordinates.size());
  Eigen::MatrixXd information = Eigen::MatrixXd::Zero(n, n);  // and below, the lower halves
  Eigen::MatrixXd correction = Eigen::MatrixXd::Zero(n, n);
  Eigen::VectorXd score = Eigen::VectorXd::Zero(n);
  for (const BandedPower& bands : replicates) {
    const Eigen::ArrayXd s = spectrum(model, bands.frequency);
    const BandLikelihood likelihood(bands.count, s);
    const std::vector<SpectralExpansion> expansions =
        expansions_of(model, coordinates, bands.frequency, order);
    std::vector<SpectralDirection> directions;
    for (const SpectralExpansion& one : expansions) {
      for (const Eigen::ArrayXd& slope : one.slopes)
        directions.push_back({slope, Eigen::MatrixXd::Ones(1, 1)});
    }
    const Eigen::MatrixXd slopes = likelihood.slopes(directions);
    const Eigen::ArrayXd power = residual_power(bands, s, ramp_power(model));
    information.triangularView<Eigen::Lower>() += slopes.transpose() * slopes;
    score += slopes.transpose() * likelihood.excess(power);
    if (!observed) continue;
    const Eigen::ArrayXd excess = (s > 0.0).select(power / s - 1.0, 0.0);
    const Eigen::MatrixXd weighted = (2.0 * excess).matrix().asDiagonal() * slopes;
    correction.triangularView<Eigen::Lower>() += slopes.transpose() * weighted;
    const Eigen::ArrayXd weight = (s > 0.0).select(0.5 * bands.count * excess / s, 0.0);
    Eigen::Index first = 0;
    for (const SpectralExpansion& one : expansions) {
      const auto size = static_cast<Eigen::Index>(one.slopes.size());
      for (Eigen::Index i = 0; i < size; ++i) {
        for (Eigen::Index j = 0; j <= i; ++j)
          correction(first + i, first + j) -=
              (weight * one.bend(static_cast<std::size_t>(i), static_cast<std::size_t>(j))).sum();
      }
      first += size;
    }
  }
  Curvature out{information.selfadjointView<Eigen::Lower>(), std::move(score), {}};
  if (observed) out.correction = correction.selfadjointView<Eigen::Lower>();
  return out;
}

// The maximum in these bands.
WhittleEstimate maximum(Model start, std::span<const BandedPower> replicates,
                        const Progress& progress, Begin begin) {
  widen_peaks(start, replicates);
  const std::vector<ParameterPlace> coordinates = coordinates_of(start);
  Eigen::VectorXd at(static_cast<Eigen::Index>(coordinates.size()));
  Likelihood likelihood;
  for (std::size_t i = 0; i < coordinates.size(); ++i) {
    at(static_cast<Eigen::Index>(i)) =
        searched(process_of(start, coordinates[i]), coordinates[i].parameter);
    likelihood.cones.push_back(coordinates[i].parameter == 0 ? 1 : Likelihood::kFree);
  }
  const auto asked_at = [&](const Eigen::VectorXd& x) {
    Model out = start;
    for (std::size_t i = 0; i < coordinates.size(); ++i) {
      const ParameterPlace& c = coordinates[i];
      set_searched(out.terms[c.term].process, c.parameter, x(static_cast<Eigen::Index>(i)));
    }
    return out;
  };
  const auto model_at = [&](const Eigen::VectorXd& x) {
    Model out = asked_at(x);
    widen_peaks(out, replicates);
    fit_ramp(out, replicates);
    return out;
  };
  likelihood.objective = [&](const Eigen::VectorXd& x) {
    return whittle_objective(model_at(x), replicates);
  };
  likelihood.curvature = [&](const Eigen::VectorXd& x, Asked asked) {
    const Model model = model_at(x);
    Curvature out = curvature_at(model, coordinates, replicates, asked);
    hold_at_limit(asked_at(x), model, coordinates, out);
    return out;
  };
  const Scored scored = begin == Begin::kNear ? fisher_scoring(likelihood, at, progress)
                                              : maximise(likelihood, at, progress);
  return {sorted(model_at(scored.at)), scored.objective, scored.termination};
}

}  // namespace

double whittle_objective(const Model& model, std::span<const BandedPower> replicates) {
  double out = 0.0;
  const double ramp2 = ramp_power(model);
  for (const BandedPower& bands : replicates) {
    const Eigen::ArrayXd s = spectrum(model, bands.frequency);
    out += BandLikelihood(bands.count, s).objective(residual_power(bands, s, ramp2));
  }
  return out;
}

Eigen::MatrixXd whittle_slopes(const Model& model, const BandedPower& bands,
                               const std::vector<Eigen::Index>& columns) {
  const auto n = static_cast<Eigen::Index>(columns.size());
  const BandLikelihood likelihood(bands.count, spectrum(model, bands.frequency));
  const std::vector<ParameterPlace> places = parameter_places(model);
  Eigen::MatrixXd out = Eigen::MatrixXd::Zero(bands.frequency.size(), n);
  for (Eigen::Index i = 0; i < n; ++i) {
    const ParameterPlace& place =
        places[static_cast<std::size_t>(columns[static_cast<std::size_t>(i)])];
    if (is_ramp(process_of(model, place))) continue;
    const double per_value = 1.0 / searched_scale(process_of(model, place), place.parameter);
    out.col(i) = per_value * likelihood.slopes({direction_of(model, place, bands.frequency)});
  }
  return out;
}

Eigen::MatrixXd whittle_information(const Model& model, std::span<const BandedPower> replicates,
                                    const std::vector<Eigen::Index>& columns) {
  const auto n = static_cast<Eigen::Index>(columns.size());
  const std::vector<ParameterPlace> places = parameter_places(model);
  Eigen::MatrixXd out = Eigen::MatrixXd::Zero(n, n);
  for (const BandedPower& bands : replicates) {
    const Eigen::MatrixXd slopes = whittle_slopes(model, bands, columns);
    out += slopes.transpose() * slopes;
    const Eigen::ArrayXd s = spectrum(model, bands.frequency);
    for (Eigen::Index i = 0; i < n; ++i) {
      const ParameterPlace& place =
          places[static_cast<std::size_t>(columns[static_cast<std::size_t>(i)])];
      const auto* ramp = std::get_if<RateRamp>(&process_of(model, place));
      if (ramp == nullptr) continue;
      out(i, i) += (bands.count * bands.ramp_power / s).sum() / (4.0 * ramp->omega2);
    }
  }
  return out;
}

WhittleEstimate whittle(const Model& start, std::span<const BandedPower> replicates,
                        const Progress& progress, Begin begin) {
  constexpr Eigen::Index kMany = 1000;  // bands: wide ones are then fewer than half as many
  const bool many = std::any_of(replicates.begin(), replicates.end(), [](const BandedPower& one) {
    return one.frequency.size() > kMany;
  });
  if (!many) return maximum(start, replicates, progress, begin);
  std::vector<BandedPower> wide;
  for (const BandedPower& one : replicates) wide.push_back(in_wider_bands(one));
  const Model rough = maximum(start, wide, progress, begin).model;
  const bool helps = whittle_objective(rough, replicates) < whittle_objective(start, replicates);
  return maximum(helps ? rough : start, replicates, progress, helps ? Begin::kNear : begin);
}

}  // namespace imunoise
