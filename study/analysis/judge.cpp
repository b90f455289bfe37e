#include "study/analysis/judge.h"

#include <algorithm>

#include "core/diagnosis/heldout.h"
#include "core/diagnosis/views/misfit.h"
#include "core/effect/columns.h"
#include "core/effects/parse_full_model.h"
#include "core/estimate/estimators.h"
#include "study/analysis/prepare.h"

namespace imunoise::study {

std::vector<std::string> witnesses_of(const FullModel& model) {
  std::vector<std::string> out;
  for (const EffectTerm& term : model.effects) {
    const bool known = std::find(out.begin(), out.end(), term.witness) != out.end();
    if (!term.witness.empty() && !known) out.push_back(term.witness);
  }
  return out;
}

Result<FullModel> started(const std::string& model, const SeenChannel& seen,
                          const Progress& progress) {
  Result<FullModel> out = parse_full_model(model, seen.subject->rate);
  if (!out) return out;
  if (auto enough = enough_scales(out->noise, seen.moments); !enough)
    return tl::unexpected(enough.error());
  for (const EffectTerm& term : out->effects) {
    if (auto fits = check(term, *seen.subject); !fits) return tl::unexpected(fits.error());
  }
  out->noise = mugmwm(out->noise, seen.moments, Weighting::kFull, progress).model;
  return out;
}

std::optional<Errors> errors_held_out(const FittedModel& model) {
  if (!can_hold_out(model)) return std::nullopt;
  return heldout_errors(model);
}

Result<v1::Rung> judge(const std::string& model, const SeenChannel& seen, const Step& step,
                       const Progress& progress) {
  const Result<FullModel> start = started(model, seen, progress.part(0.0, 0.1));
  if (!start) return tl::unexpected(start.error());
  const FittedModel trial = fit_full_model(seen.subject, *start, progress.part(0.1, 0.3));
  const std::optional<Errors> heldout = errors_held_out(trial);
  progress.report(0.7);
  const double misfit_p = misfit_p_value(misfit_of(trial));
  if (progress.stopped()) return fail("stopped");
  return rung_of(trial, left_over(trial), step, 0.0, misfit_p, heldout);
}

}  // namespace imunoise::study
