#include "core/regression/own_ratios.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "core/effect/columns.h"
#include "core/estimate/whittle.h"
#include "core/regression/fitted_model.h"
#include "core/support/distributions.h"
#include "core/support/linear_algebra.h"
#include "core/support/parallel.h"

namespace imunoise {
namespace {

// The processes whose power is free, and there, in all replicates.
std::vector<std::size_t> common_terms(const JointFit& fit) {
  const auto there = [](const Term& term) { return values(term.process)[0] > 0.0; };
  std::vector<std::size_t> out;
  for (std::size_t t = 0; t < fit.model.noise.terms.size(); ++t) {
    if (fit.model.noise.terms[t].given[0] || !there(fit.model.noise.terms[t])) continue;
    const bool in_all = std::all_of(fit.own_noise.begin(), fit.own_noise.end(),
                                    [&](const Model& own) { return there(own.terms[t]); });
    if (in_all) out.push_back(t);
  }
  return out;
}

// A free parameter of the noise.
struct Place {
  std::size_t term;
  std::size_t parameter;
  Eigen::Index column;  ///< of all parameters of all terms
};

// The powers of `terms`, in that order, then all else that is free in a replicate's own noise.
std::vector<Place> free_places(const Model& own, const std::vector<std::size_t>& terms,
                               bool shapes) {
  std::vector<Place> out;
  std::vector<Place> others;
  Eigen::Index column = 0;
  for (std::size_t t = 0; t < own.terms.size(); ++t) {
    const std::vector<double> now = values(own.terms[t].process);
    for (std::size_t p = 0; p < now.size(); ++p, ++column) {
      if (!(now[0] > 0.0) || own.terms[t].given[p] || (p > 0 && !shapes)) continue;
      const bool counts = p == 0 && std::find(terms.begin(), terms.end(), t) != terms.end();
      (counts ? out : others).push_back({t, p, column});
    }
  }
  out.insert(out.end(), others.begin(), others.end());
  return out;
}

// What is free in the noise of one replicate.
struct OwnNoise {
  std::vector<Place> places;
  Eigen::VectorXd value;
  Eigen::MatrixXd covariance;  ///< by Whittle's information
};

std::vector<OwnNoise> own_noises(const FittedEffect& effect, const std::vector<std::size_t>& terms,
                                 bool shapes) {
  const Regression& regression = effect.model.regression;
  const JointFit& fit = effect.model.fit;
  const std::vector<BandedPower> residual = regression.residual(fit.effects.value);
  std::vector<OwnNoise> out(residual.size());
  for_each_index(out.size(), [&](std::size_t i) {
    const Model& own = fit.own_noise[regression.replicates()[i]];
    out[i].places = free_places(own, terms, shapes);
    const auto count = static_cast<Eigen::Index>(out[i].places.size());
    out[i].value.resize(count);
    std::vector<Eigen::Index> columns;
    for (const Place& one : out[i].places) {
      out[i].value(static_cast<Eigen::Index>(columns.size())) =
          values(own.terms[one.term].process)[one.parameter];
      columns.push_back(one.column);
    }
    out[i].covariance =
        pseudo_inverse(whittle_information(own, std::span(&residual[i], 1), columns)).matrix;
  });
  return out;
}

// "AR1", or "AR1 2" where it is the second of its kind.
std::string name_among(const Model& model, std::size_t term) {
  const std::string_view name = info(model.terms[term].process).name;
  const auto before =
      std::count_if(model.terms.begin(), model.terms.begin() + static_cast<std::ptrdiff_t>(term),
                    [&](const Term& one) { return info(one.process).name == name; });
  return before == 0 ? std::string(name) : fmt::format("{} {}", name, before + 1);
}

// Logarithms of powers of each replicate over those of all, with their standard errors.
struct LogRatios {
  std::string of;  ///< a process; nothing: of all
  Eigen::ArrayXd value;
  Eigen::ArrayXd error;

  double spread() const {
    const double dof = static_cast<double>(value.size() - 1);
    return std::sqrt((value - value.mean()).square().sum() / dof);
  }
  /// χ² of replicates that are alike.
  double chi() const {
    const Eigen::ArrayXd weight = error.square().inverse();
    const double mean = (weight * value).sum() / weight.sum();
    return (weight * (value - mean).square()).sum();
  }
  /// Of a replicate against all, to which it contributed its share.
  double error_beside_all(Eigen::Index k) const {
    const double share = 1.0 / (error.square().inverse().sum() * error(k) * error(k));
    return error(k) * std::sqrt(1.0 - share);
  }
  ReportedNumber in_replicate(Eigen::Index k, const std::string& name) const {
    return with_log_error({name, std::exp(value(k)), "1"}, error_beside_all(k));
  }
};

struct Ratios {
  LogRatios whole;  ///< one for all processes: generalised least squares of their logarithms
  std::vector<LogRatios> processes;
  Eigen::ArrayXd unlike;  ///< χ² of the processes against that one, a replicate each
};

Ratios ratios_of(const std::vector<OwnNoise>& each, const std::vector<std::size_t>& terms,
                 const Model& all) {
  const auto count = static_cast<Eigen::Index>(terms.size());
  const Eigen::ArrayXd none = Eigen::ArrayXd::Zero(static_cast<Eigen::Index>(each.size()));
  Ratios out{{"", none, none}, {}, none};
  Eigen::VectorXd common(count);
  for (const std::size_t t : terms) {
    common(static_cast<Eigen::Index>(out.processes.size())) = values(all.terms[t].process)[0];
    out.processes.push_back({name_among(all, t), none, none});
  }
  for (Eigen::Index k = 0; k < none.size(); ++k) {
    const OwnNoise& own = each[static_cast<std::size_t>(k)];
    const Eigen::VectorXd power = own.value.head(count);
    const Eigen::VectorXd logs = (power.array() / common.array()).log();
    const Eigen::VectorXd inverse = power.cwiseInverse();
    const Eigen::MatrixXd covariance =
        inverse.asDiagonal() * own.covariance.topLeftCorner(count, count) * inverse.asDiagonal();
    for (Eigen::Index t = 0; t < count; ++t) {
      LogRatios& process = out.processes[static_cast<std::size_t>(t)];
      process.value(k) = logs(t);
      process.error(k) = std::sqrt(covariance(t, t));
    }
    const Eigen::VectorXd weight = solve_symmetric(covariance, Eigen::VectorXd::Ones(count));
    out.whole.value(k) = weight.dot(logs) / weight.sum();
    out.whole.error(k) = 1.0 / std::sqrt(weight.sum());
    const Eigen::VectorXd apart = logs.array() - out.whole.value(k);
    out.unlike(k) = apart.dot(solve_symmetric(covariance, apart));
  }
  return out;
}

// The ratio of what differs most: of all powers, or of a process.
const LogRatios& most_different(const Ratios& ratios) {
  const LogRatios* out = &ratios.whole;
  for (const LogRatios& one : ratios.processes) {
    if (one.chi() > out->chi()) out = &one;
  }
  return *out;
}

// The ratio of each replicate; of each process in it where one does not tell all. What is not known
// within a factor of 20 is left out.
void add_ratios(const Ratios& ratios, std::vector<ReportedNumber>& out) {
  constexpr double kBeyondChance = 0.01;
  constexpr double kKnown = 1.5;  // standard error of the logarithm
  const auto dof = static_cast<double>(ratios.processes.size()) - 1.0;
  const bool alike =
      !(dof > 0.0) ||
      chi_square_tail(ratios.unlike.sum(), dof * static_cast<double>(ratios.unlike.size())) >
          kBeyondChance;
  for (Eigen::Index k = 0; k < ratios.unlike.size(); ++k) {
    if (alike) {
      out.push_back(
          ratios.whole.in_replicate(k, fmt::format("power ratio of replicate {}", k + 1)));
      continue;
    }
    for (const LogRatios& one : ratios.processes) {
      if (one.error(k) < kKnown)
        out.push_back(
            one.in_replicate(k, fmt::format("power ratio of {} in replicate {}", one.of, k + 1)));
    }
  }
}

// The shapes of each replicate's noise.
void add_shapes(const std::vector<OwnNoise>& each, const Model& all,
                std::vector<ReportedNumber>& out) {
  for (std::size_t k = 0; k < each.size(); ++k) {
    for (std::size_t i = 0; i < each[k].places.size(); ++i) {
      const Place& one = each[k].places[i];
      if (one.parameter == 0) continue;
      const Process& process = all.terms[one.term].process;
      const ParameterInfo about = parameters(process)[one.parameter];
      const auto at = static_cast<Eigen::Index>(i);
      out.push_back(with_error(
          {fmt::format("{} of {} in replicate {}", about.name, info(process).name, k + 1),
           each[k].value(at), about.dimension == Dimension::kSeconds ? "s" : "1"},
          std::sqrt(each[k].covariance(at, at))));
    }
  }
}

}  // namespace

std::vector<ReportedNumber> own_ratios(const FittedEffect& effect, bool shapes) {
  const JointFit& fit = effect.model.fit;
  const std::vector<std::size_t> terms = common_terms(fit);
  const std::vector<OwnNoise> each = own_noises(effect, terms, shapes);
  std::vector<ReportedNumber> out;
  if (!terms.empty()) {
    const Ratios ratios = ratios_of(each, terms, fit.model.noise);
    if (each.size() > 1) {
      const LogRatios& most = most_different(ratios);
      const double dof = static_cast<double>(each.size() - 1);
      out.push_back(
          with_log_error({most.of.empty() ? "spread" : "spread of " + most.of, most.spread(), "1"},
                         1.0 / std::sqrt(2.0 * dof)));
    }
    add_ratios(ratios, out);
  }
  if (shapes) add_shapes(each, fit.model.noise, out);
  return out;
}

}  // namespace imunoise
