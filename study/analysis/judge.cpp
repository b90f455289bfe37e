#include "study/analysis/judge.h"

#include "core/diagnosis/heldout.h"
#include "core/diagnosis/views/misfit.h"
#include "core/effects/parse_full_model.h"
#include "study/analysis/less_effects.h"
#include "study/analysis/rung_picture.h"

namespace imunoise::study {

Result<FullModel> started(const std::string& model, const SeenChannel& seen,
                          const Progress& progress) {
  const auto written = parse_full_model(model, seen.subject->rate);
  if (!written) return tl::unexpected(written.error());
  auto out = as_fitted(*written);
  if (!out) return out;
  return start_of(std::move(*out), *seen.subject, seen.moments, progress);
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
  const LeftOver left = left_over(trial);
  v1::Rung out = rung_of(trial, left, step, 0.0, misfit_p, heldout);
  *out.mutable_picture() = picture_of(trial, left, seen.name, seen.replicates);
  return out;
}

}  // namespace imunoise::study
