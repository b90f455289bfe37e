#include "study/analysis/evaluate.h"

#include "core/diagnosis/heldout.h"
#include "core/diagnosis/missing_resonance.h"
#include "core/diagnosis/views/left_over.h"
#include "core/diagnosis/views/misfit.h"
#include "core/effects/parse_full_model.h"
#include "study/analysis/less_effects.h"
#include "study/analysis/rung_picture.h"

namespace imunoise::study {

Result<FullModel> started(const std::string& model, const PreparedChannel& prepared,
                          const Progress& progress) {
  const auto written = parse_full_model(model, prepared.subject->rate);
  if (!written) return tl::unexpected(written.error());
  return start_of(as_fitted(*written), *prepared.subject, prepared.moments, progress);
}

Result<v1::Rung> evaluate(const std::string& model, const PreparedChannel& prepared,
                          const Step& step, const Progress& progress) {
  const Result<FullModel> start = started(model, prepared, progress.part(0.0, 0.1));
  if (!start) return tl::unexpected(start.error());
  const FittedModel trial = fit_with_resonances(prepared.subject, *start, progress.part(0.1, 0.3));
  const std::optional<HeldOut> heldout = held_out(trial);
  progress.report(0.7);
  const MisfitReport misfit = misfit_of(trial);
  if (progress.stopped()) return fail("stopped");
  const LeftOver left = left_over(trial);
  v1::Rung out = rung_of({trial, left, misfit, heldout}, step, 0.0, prepared.replicates);
  *out.mutable_picture() = picture_of(trial, left, prepared.name, prepared.replicates);
  return out;
}

}  // namespace imunoise::study
