#include "core/dynamic/dynamic_fit.h"

#include <algorithm>
#include <cassert>

#include "core/dynamic/dynamic_blocks.h"
#include "core/dynamic/trend_start.h"
#include "core/support/parallel.h"

namespace imunoise {
namespace {

constexpr int kReweightings = 2;

CovariateAxis axis_of(const std::vector<CovariateBin>& bins) {
  const auto [low, high] =
      std::minmax_element(bins.begin(), bins.end(),
                          [](const auto& a, const auto& b) { return a.covariate < b.covariate; });
  assert(low->covariate < high->covariate);
  return {0.5 * (low->covariate + high->covariate), 0.5 * (high->covariate - low->covariate)};
}

std::vector<std::optional<Fit>> separate_fits(const Model& open,
                                              const std::vector<CovariateBin>& bins,
                                              double confidence, const Progress& progress) {
  const Model plain = model_at(open, 0.0);
  std::size_t free = 0;
  for (const Term& term : plain.terms) {
    free += static_cast<std::size_t>(std::count(term.given.begin(), term.given.end(), false));
  }
  std::vector<std::optional<Fit>> out(bins.size());
  for_each_index(bins.size(), [&](std::size_t b) {
    const std::vector<WaveletVariance>& runs = bins[b].runs;
    const bool enough = std::any_of(runs.begin(), runs.end(), [&](const WaveletVariance& one) {
      return one.scales.size() >= free;
    });
    if (!enough || progress.stopped()) return;
    out[b] = infer(mugmwm(plain, runs, Weighting::kFull, progress), runs, confidence);
  });
  return out;
}

RunRoots first_roots(const std::vector<CovariateBin>& bins,
                     const std::vector<std::optional<Fit>>& separate) {
  RunRoots out;
  for (std::size_t b = 0; b < bins.size(); ++b) {
    out.push_back(separate[b] ? separate[b]->estimate.weight_roots : diagonal_roots(bins[b].runs));
  }
  return out;
}

// Full weights under a model; false when it gives none in some bin.
bool reweigh(const Model& model, const CovariateAxis& axis, const std::vector<CovariateBin>& bins,
             RunRoots& roots) {
  std::vector<Model> at;
  for (const CovariateBin& bin : bins) {
    at.push_back(model_at(model, axis(bin.covariate)));
    if (!gives_weights(at.back(), bin.runs)) return false;
  }
  for_each_index(bins.size(), [&](std::size_t b) { roots[b] = full_roots(at[b], bins[b].runs); });
  return true;
}

}  // namespace

Problem dynamic_problem(const Model& model, const CovariateAxis& axis,
                        const std::vector<CovariateBin>& bins, const RunRoots& roots) {
  Problem out{model, {}};
  for (std::size_t b = 0; b < bins.size(); ++b) {
    for (MomentBlock& block : tied_problem(model, bins[b].runs, roots[b]).blocks) {
      for (Segment& segment : block.segments) segment.covariate = axis(bins[b].covariate);
      out.blocks.push_back(std::move(block));
    }
  }
  return out;
}

DynamicFit fit_dynamic(const Model& open, const std::vector<CovariateBin>& bins, double confidence,
                       const Progress& progress) {
  assert(varies(open));
  DynamicFit fit;
  fit.axis = axis_of(bins);
  fit.rate = bins.front().runs.front().rate;
  fit.confidence = confidence;
  fit.separate = separate_fits(open, bins, confidence, progress);
  progress.report(0.5);
  RunRoots roots = first_roots(bins, fit.separate);
  std::vector<double> covariates;
  for (const CovariateBin& bin : bins) covariates.push_back(fit.axis(bin.covariate));

  std::vector<Model> starts = trend_starts(open, covariates, fit.separate);
  const Problem first = dynamic_problem(open, fit.axis, bins, roots);
  starts.push_back(minimise(first, progress).model);
  Minimum found = minimise_from(first, starts, progress);
  for (int round = 0; round < kReweightings && !progress.stopped(); ++round) {
    if (!reweigh(found.model, fit.axis, bins, roots)) break;
    // All starts compete once more under the weights of the model; the next round follows the best.
    if (round > 0) starts.clear();
    starts.push_back(found.model);
    found = minimise_from(dynamic_problem(open, fit.axis, bins, roots), starts, progress);
  }
  fit.model = sorted(std::move(found.model));
  fit.objective = found.objective;
  fit.termination = found.termination;
  progress.report(0.8);
  infer(fit, bins, roots);
  progress.report(1.0);
  return fit;
}

}  // namespace imunoise
