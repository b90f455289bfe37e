#include "study/report/figures/study_figure.h"

#include <algorithm>
#include <cmath>
#include <iterator>

#include "study/report/figures/budget_figure.h"
#include "study/report/figures/comparison_figures.h"
#include "study/report/view/verdict.h"

namespace imunoise::report {
namespace {

using figure::Figure;

// What figures of a comparison want to know of its report.
v1::DiagnosisReport about(const v1::Study& study) {
  v1::DiagnosisReport out;
  out.set_channel(study.channel());
  out.set_unit(study.unit());
  out.set_rate_hz(study.rate_hz());
  *out.mutable_candidates() = study.diagnosis().candidates();
  return out;
}

// What the other model would show of the samples as they are: its noise, and what its effects take
// out of them.
void add_ghost(const v1::NoiseBudget& from, BudgetView& to) {
  const BudgetView other = budget_view(from);
  for (ScaleView& scale : to.scales) {
    const auto same = std::find_if(other.scales.begin(), other.scales.end(), [&](const auto& one) {
      return std::abs(one.seconds - scale.seconds) < 1e-9 * scale.seconds;
    });
    if (same == other.scales.end()) continue;
    const double explained = std::max(0.0, scale.measured - same->measured);
    scale.ghost = same->model + explained;
    scale.ghost_residual = same->residual;
  }
}

Figure averaging_times(const v1::Study& study, const v1::Rung& rung,
                       const StudyFigureOptions& options) {
  BudgetView view = budget_view(rung.picture());
  if (options.preview != nullptr) add_ghost(options.preview->budget(), view);
  if (!options.variance) view = as_allan(std::move(view), allan_unit(study.unit(), options.si));
  return budget_figure(view, {.channel = study.channel(),
                              .unit = study.unit(),
                              .subtitle = rung.model(),
                              .confidence = 0.95,
                              .mark_misfits = fails(verdict_at(rung.misfit_p())),
                              .allan = !options.variance,
                              .si = options.si});
}

std::optional<Figure> spectrum(const v1::Study& study, const v1::RungPicture& picture,
                               const v1::RungPicture* preview) {
  auto out = spectrum_figure(about(study), picture.compared(), "Spectrum of " + study.channel());
  if (out) out->cursor = true;
  if (!out || preview == nullptr) return out;
  figure::Layer ghost{
      .shape = figure::Shape::kLine, .role = figure::Role::kGhost, .key = "with the change"};
  for (const v1::SpectrumPoint& one : preview->compared().spectrum())
    ghost.data.push_back({.x = one.frequency_hz(), .y = one.model()});
  out->panels.front().layers.push_back(std::move(ghost));
  return out;
}

// One picture of several figures: their panels side by side, each under its title.
std::optional<Figure> joined(std::vector<Figure> figures) {
  if (figures.empty()) return std::nullopt;
  if (figures.size() == 1) return std::move(figures.front());
  Figure out{.title = figures.front().title, .columns = 2};
  for (Figure& one : figures) {
    one.panels.front().title = one.title;
    out.caption += (out.caption.empty() ? "" : " ") + one.caption;
    std::move(one.panels.begin(), one.panels.end(), std::back_inserter(out.panels));
  }
  return out;
}

}  // namespace

const std::vector<std::string>& study_views() {
  static const std::vector<std::string> kViews = {"averaging_times", "spectrum",  "time",
                                                  "distribution",    "witnesses", "replicates"};
  return kViews;
}

std::optional<Figure> study_figure(const v1::Study& study, const StudyFigureOptions& options) {
  const v1::Rung& rung = study.attempts(static_cast<int>(options.attempt)).rung();
  const v1::Comparison& compared = rung.picture().compared();
  if (options.view == "averaging_times") return averaging_times(study, rung, options);
  if (options.view == "spectrum") return spectrum(study, rung.picture(), options.preview);
  if (options.view == "time") return times_figure(compared);
  if (options.view == "distribution") {
    auto out = kurtosis_figure(compared);
    if (out) out->cursor = true;
    return out;
  }
  if (options.view == "witnesses") return joined(witness_figures(compared));
  return deviations_figure(about(study), compared);
}

}  // namespace imunoise::report
