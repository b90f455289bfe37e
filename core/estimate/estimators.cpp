#include "core/estimate/estimators.h"

#include <algorithm>
#include <cmath>
#include <optional>

#include "core/estimate/match_terms.h"
#include "core/support/linear_algebra.h"
#include "core/wavelet/moment_covariance.h"

namespace imunoise {
namespace {

constexpr int kMostReweightings = 2;
constexpr int kMostDamped = 12;    // rounds more, where the last one still moved the estimate
constexpr double kSettled = 0.25;  // of the variance at a scale

const WaveletVariance& longest(std::span<const WaveletVariance> replicates) {
  return *std::max_element(replicates.begin(), replicates.end(), [](const auto& a, const auto& b) {
    return a.scales.size() < b.scales.size();
  });
}

std::vector<Eigen::MatrixXd> whitening_roots(const MomentCovariances& covariances,
                                             std::span<const WaveletVariance> replicates) {
  const auto roots = PerReplicate<Eigen::MatrixXd>::of(
      replicates, [&](std::size_t k) { return whiten(covariances[k]).matrix; });
  std::vector<Eigen::MatrixXd> out;
  for (std::size_t k = 0; k < replicates.size(); ++k) out.push_back(roots[k]);
  return out;
}

MomentCovariances mean_of(const MomentCovariances& a, const MomentCovariances& b,
                          std::span<const WaveletVariance> replicates) {
  return MomentCovariances::of(
      replicates, [&](std::size_t k) -> Eigen::MatrixXd { return 0.5 * (a[k] + b[k]); });
}

double disagreement(const Model& average, const std::vector<Estimate>& separate, HalfWidths m) {
  Eigen::ArrayXd mean = Eigen::ArrayXd::Zero(m.size());
  for (const Estimate& one : separate)
    mean += variance(one.model, m) / static_cast<double>(separate.size());
  const Eigen::ArrayXd ratio = variance(average, m) / mean;
  return std::exp(ratio.log().abs().maxCoeff());
}

// Correlation of neighbours and variance of a free Markov process.
struct Memory {
  double phi = 1.0;
  double variance = 0.0;
};

Memory memory_of(const Term& term) {
  const auto of = [](const Ar1& one) {
    return Memory{one.phi, one.sigma2 / (1.0 - one.phi * one.phi)};
  };
  if (std::find(term.given.begin(), term.given.end(), true) != term.given.end()) return {};
  if (const auto* markov = std::get_if<Ar1>(&term.process)) return of(*markov);
  const auto* markov = std::get_if<GaussMarkov>(&term.process);
  return markov == nullptr ? Memory{} : of(markov->discrete());
}

// The Markov process that may be white noise, while a term for that has no power.
std::optional<std::size_t> white_by_another_name(const Model& model) {
  constexpr double kNoPower = 1e-3;
  constexpr double kNextToNone = 0.3;
  const WhiteNoise* white = nullptr;
  for (const Term& term : model.terms) {
    if (const auto* one = std::get_if<WhiteNoise>(&term.process); one && !term.given[0])
      white = one;
  }
  if (white == nullptr) return std::nullopt;
  for (std::size_t t = 0; t < model.terms.size(); ++t) {
    const Memory memory = memory_of(model.terms[t]);
    if (memory.phi < kNextToNone && white->sigma2 < kNoPower * memory.variance) return t;
  }
  return std::nullopt;
}

// Where the data show no memory, the noise is the white noise's.
void name_white_noise(const Model& open, std::span<const WaveletVariance> replicates,
                      const std::vector<Eigen::MatrixXd>& roots, const Progress& progress,
                      Minimum& found) {
  const std::optional<std::size_t> markov = white_by_another_name(found.model);
  if (!markov) return;
  const auto at = static_cast<std::ptrdiff_t>(*markov);
  Model less = open;
  less.terms.erase(less.terms.begin() + at);
  Minimum white = minimise(tied_problem(less, replicates, roots), progress);
  name_white_noise(less, replicates, roots, progress,
                   white);          // another one may have taken its place
  constexpr double kChance = 3.84;  // of χ² with a degree of freedom, once in twenty
  if (white.objective > found.objective + kChance) return;
  // Without power it has any memory; a bound on its power means most in the middle of the scales.
  const double memory = std::sqrt(static_cast<double>(longest(replicates).scales.largest()));
  Term none = found.model.terms[*markov];
  if (auto* process = std::get_if<Ar1>(&none.process)) {
    *process = {.sigma2 = 0.0, .phi = std::exp(-1.0 / memory)};
  } else {
    auto& slow = std::get<GaussMarkov>(none.process);
    slow.sigma2 = 0.0;
    slow.tc = memory / slow.rate.value;
  }
  white.model.terms.insert(white.model.terms.begin() + at, std::move(none));
  found.model = std::move(white.model);
  found.objective = white.objective;
}

}  // namespace

MomentCovariances moment_covariances(const Model& model,
                                     std::span<const WaveletVariance> replicates) {
  const SumCovariance process = sum_covariance(model);
  return MomentCovariances::of(replicates, [&](std::size_t k) -> Eigen::MatrixXd {
    const WaveletVariance& wv = replicates[k];
    return moment_covariance(process, wv.scales, wv.samples) / wv.efficiency;
  });
}

std::vector<Eigen::MatrixXd> full_roots(const Model& model,
                                        std::span<const WaveletVariance> replicates) {
  return whitening_roots(moment_covariances(model, replicates), replicates);
}

bool gives_weights(const Model& model, std::span<const WaveletVariance> replicates) {
  const SumCovariance sum = sum_covariance(model);
  const bool random = sum.linear != 0.0 || sum.cubic != 0.0 || !sum.near.empty() ||
                      !sum.exponentials.empty() || sum.flicker > 0.0;
  return random && (variance(model, longest(replicates).scales.half_widths()) > 0.0).all();
}

std::vector<Eigen::MatrixXd> diagonal_roots(std::span<const WaveletVariance> replicates) {
  std::vector<Eigen::MatrixXd> out;
  for (const WaveletVariance& wv : replicates) {
    const Eigen::ArrayXd width = wv.upper - wv.lower;
    out.emplace_back((width > 0.0).select(1.0 / width, 0.0).matrix().asDiagonal());
  }
  return out;
}

Problem tied_problem(const Model& model, std::span<const WaveletVariance> replicates,
                     std::span<const Eigen::MatrixXd> weight_roots) {
  std::vector<Share> all;
  for (std::size_t t = 0; t < model.terms.size(); ++t) all.push_back({t, 0});
  Problem out{model, {}};
  double within = 0.0;  // Σ over replicates of their distance from the average they enter as
  std::vector<bool> done(replicates.size(), false);
  for (std::size_t k = 0; k < replicates.size(); ++k) {
    if (done[k]) continue;
    std::vector<std::size_t> group;
    Eigen::VectorXd mean = Eigen::VectorXd::Zero(replicates[k].variance.size());
    for (std::size_t l = k; l < replicates.size(); ++l) {
      if (done[l] || !(replicates[l].scales == replicates[k].scales) ||
          weight_roots[l] != weight_roots[k]) {
        continue;
      }
      done[l] = true;
      group.push_back(l);
      mean += replicates[l].variance.matrix();
    }
    const auto count = static_cast<double>(group.size());
    mean /= count;
    for (const std::size_t l : group) {
      within += (weight_roots[l] * (replicates[l].variance.matrix() - mean)).squaredNorm();
    }
    out.blocks.push_back({{{replicates[k].scales, all}}, mean, std::sqrt(count) * weight_roots[k]});
  }
  // A moment that no term explains adds this constant to the objective.
  out.blocks.push_back({{{Scales({1}), {}}},
                        Eigen::VectorXd::Constant(1, std::sqrt(within)),
                        Eigen::MatrixXd::Identity(1, 1)});
  return out;
}

Estimate mugmwm(const Model& model, std::span<const WaveletVariance> replicates,
                Weighting weighting, const Progress& progress) {
  Estimate out;
  out.weighting = weighting;
  out.weight_roots = diagonal_roots(replicates);
  const Problem first = tied_problem(model, replicates, out.weight_roots);
  const bool full = weighting == Weighting::kFull;
  Minimum found = full ? minimise_roughly(first, progress) : minimise(first, progress);
  if (full && !gives_weights(found.model, replicates)) found = minimise(first, progress);
  const Eigen::ArrayXd m = longest(replicates).scales.half_widths();
  std::optional<MomentCovariances> believed;
  for (int round = 0; full && round < kMostReweightings + kMostDamped; ++round) {
    if (progress.stopped() || !gives_weights(found.model, replicates)) break;
    const Eigen::ArrayXd before = variance(found.model, m);
    MomentCovariances now = moment_covariances(found.model, replicates);
    // Weights and estimate may chase each other: the mean of two rounds ends that.
    if (round >= kMostReweightings) now = mean_of(*believed, now, replicates);
    out.weight_roots = whitening_roots(now, replicates);
    believed = std::move(now);
    const Problem problem = tied_problem(model, replicates, out.weight_roots);
    // The whole search is made once, with the first full weights; later rounds follow it.
    found =
        round == 0 ? minimise(problem, progress) : minimise_from(problem, found.model, progress);
    const Eigen::ArrayXd after = variance(found.model, m);
    const double moved = ((after - before).abs() / after).maxCoeff();
    if (moved <= 1e-7 || (round + 1 >= kMostReweightings && moved <= kSettled)) break;
  }
  if (full && gives_weights(found.model, replicates))
    name_white_noise(model, replicates, out.weight_roots, progress, found);
  out.model = sorted(std::move(found.model));
  out.objective = found.objective;
  out.termination = found.termination;
  return out;
}

AverageEstimate agmwm(const Model& model, std::span<const WaveletVariance> replicates,
                      Weighting weighting, const Progress& progress) {
  AverageEstimate out;
  Estimate& average = out.average;
  average.model = model;
  average.weighting = weighting;
  std::vector<std::vector<double>> sums;
  for (const Term& term : model.terms) sums.emplace_back(term.given.size(), 0.0);
  const auto count = static_cast<double>(replicates.size());
  const Eigen::ArrayXd m = longest(replicates).scales.half_widths();
  // Equal terms of separate fits belong together where they explain the same.
  std::optional<Model> reference;
  if (has_equal_terms(model)) reference = mugmwm(model, replicates, weighting).model;
  for (std::size_t k = 0; k < replicates.size(); ++k) {
    const auto at = static_cast<double>(k);
    Estimate one = mugmwm(model, replicates.subspan(k, 1), weighting,
                          progress.part(at / count, (at + 1) / count));
    if (reference) one.model = matched(one.model, *reference, m);
    average.objective += one.objective;
    if (one.termination != Termination::kConverged) average.termination = one.termination;
    average.weight_roots.push_back(one.weight_roots[0]);
    for (std::size_t t = 0; t < sums.size(); ++t) {
      const std::vector<double> v = values(one.model.terms[t].process);
      for (std::size_t p = 0; p < v.size(); ++p) sums[t][p] += v[p] / count;
    }
    out.separate.push_back(std::move(one));
  }
  for (std::size_t t = 0; t < sums.size(); ++t) set_values(average.model.terms[t].process, sums[t]);
  out.disagreement = disagreement(average.model, out.separate, m);
  average.model = sorted(std::move(average.model));
  return out;
}

}  // namespace imunoise
