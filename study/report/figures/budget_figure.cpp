#include "study/report/figures/budget_figure.h"

#include <algorithm>
#include <cmath>
#include <numbers>

#include "study/report/view/verdict.h"
#include "study/words/number.h"
#include "study/words/text.h"

namespace imunoise::report {
namespace {

using figure::AxisKind;
using figure::Datum;
using figure::kUnknown;
using figure::Layer;
using figure::Panel;
using figure::Role;
using figure::Shape;
using figure::State;

State state_of(const ScaleView& scale) {
  if (scale.outside()) return State::kOutside;
  return scale.tested ? State::kPlain : State::kUntested;
}

// Where the column of a scale begins and ends on the axis of times: half way to its neighbours. The
// outermost run to the edge.
double column_begin(const std::vector<ScaleView>& scales, std::size_t k) {
  return k == 0 ? kUnknown : std::sqrt(scales[k - 1].seconds * scales[k].seconds);
}
double column_end(const std::vector<ScaleView>& scales, std::size_t k) {
  return k + 1 == scales.size() ? kUnknown : column_begin(scales, k + 1);
}

template <class Value>
Layer line(Role role, const std::vector<ScaleView>& scales, Value value) {
  Layer out{.shape = Shape::kLine, .role = role};
  for (const ScaleView& scale : scales) out.data.push_back({.x = scale.seconds, .y = value(scale)});
  return out;
}

bool any_known(const Layer& layer) {
  return std::any_of(layer.data.begin(), layer.data.end(),
                     [](const Datum& one) { return std::isfinite(one.y); });
}

void add_misfits(const BudgetView& view, Panel& to) {
  Layer out{.shape = Shape::kColumns, .role = Role::kMisfit};
  for (const Misfit& one : misfits(view)) {
    out.data.push_back({.lower = column_begin(view.scales, one.first),
                        .upper = column_end(view.scales, one.last)});
  }
  to.layers.push_back(std::move(out));
}

void add_terms(const BudgetView& view, Panel& to) {
  for (std::size_t t = 0; t < view.terms.size(); ++t) {
    Layer term = line(Role::kTerm, view.scales, [t](const ScaleView& s) { return s.terms[t]; });
    term.name = view.terms[t];
    term.style = t;
    term.labelled = true;
    term.widens = false;  // a term may leave through the floor
    if (t == 0) term.key = "terms";
    to.layers.push_back(std::move(term));
  }
}

void add_replicates(const BudgetView& view, Panel& to) {
  if (view.replicates.size() < 2) return;
  for (const ReplicateView& replicate : view.replicates) {
    Layer one =
        line(Role::kReplicate, replicate.scales, [](const ScaleView& s) { return s.measured; });
    one.name = replicate.name;
    one.key = "replicates";
    to.layers.push_back(std::move(one));
  }
}

void add_measured(const BudgetView& view, Panel& to) {
  Layer band{.shape = Shape::kBand, .role = Role::kInterval};
  Layer points{
      .shape = Shape::kPoints, .role = Role::kMeasured, .name = "measured", .key = "measured"};
  for (const ScaleView& scale : view.scales) {
    const bool known = scale.measured > 0.0 && scale.upper > 0.0 && std::isfinite(scale.lower);
    Datum point{
        .x = scale.seconds, .y = scale.measured, .state = state_of(scale), .sigma = scale.residual};
    if (known) {
      point.lower = scale.lower;
      point.upper = scale.upper;
      band.data.push_back(point);
    }
    points.data.push_back(point);
  }
  to.layers.insert(to.layers.begin(), std::move(band));
  to.layers.push_back(std::move(points));
}

Panel budget_panel(const BudgetView& view, const BudgetWords& words) {
  const AllanUnit allan = allan_unit(words.unit, words.si);
  Panel out{.x = {.kind = AxisKind::kLogarithmic, .title = "averaging time, s"},
            .y = {.kind = AxisKind::kLogarithmic,
                  .title = "wavelet variance ν, " + squared(words.unit),
                  .short_title = "ν, " + squared(words.unit)},
            .height = 400.0};
  if (words.allan) {
    out.y.title = "Allan deviation, " + allan.unit;
    out.y.short_title = "Allan dev., " + allan.unit;
  } else {
    out.right = {{.title = "Allan deviation √(2ν), " + allan.unit,
                  .short_title = "Allan dev., " + allan.unit,
                  .factor = std::numbers::sqrt2 * allan.factor,
                  .exponent = 0.5}};
  }
  add_replicates(view, out);
  add_terms(view, out);
  Layer model = line(Role::kModel, view.scales, [](const ScaleView& s) { return s.model; });
  model.name = "model";
  model.key = "model";
  if (any_known(model)) out.layers.push_back(std::move(model));
  Layer ghost = line(Role::kGhost, view.scales, [](const ScaleView& s) { return s.ghost; });
  ghost.key = "with the change";
  if (any_known(ghost)) out.layers.push_back(std::move(ghost));
  add_measured(view, out);
  if (words.mark_misfits) add_misfits(view, out);
  return out;
}

Panel residual_panel(const BudgetView& view) {
  Layer chance{.shape = Shape::kRows,
               .role = Role::kChance,
               .data = {{.lower = -kSigmaLimit, .upper = kSigmaLimit}}};
  Layer untested{.shape = Shape::kColumns, .role = Role::kUntested};
  Layer bars{.shape = Shape::kBars, .role = Role::kMeasured, .name = "residual"};
  for (std::size_t k = 0; k < view.scales.size(); ++k) {
    const ScaleView& scale = view.scales[k];
    bars.data.push_back({.x = scale.seconds,
                         .y = scale.residual,
                         .state = state_of(scale),
                         .sigma = scale.residual});
    if (scale.tested) continue;
    const bool goes_on = k > 0 && !view.scales[k - 1].tested;
    if (!goes_on) untested.data.push_back({.lower = column_begin(view.scales, k)});
    untested.data.back().upper = column_end(view.scales, k);
  }
  Panel out{.x = {.kind = AxisKind::kLogarithmic},
            .y = {.kind = AxisKind::kSigma, .title = "residual, σ"},
            .shares_x = true,
            .height = 120.0,
            .layers = {std::move(chance), std::move(untested), std::move(bars)}};
  Layer ghost =
      line(Role::kGhost, view.scales, [](const ScaleView& s) { return s.ghost_residual; });
  if (any_known(ghost)) out.layers.push_back(std::move(ghost));
  return out;
}

std::string budget_caption(const BudgetView& view, const BudgetWords& words) {
  std::string out =
      words.allan ? "Allan deviation against its averaging time m/f. "
                  : "Haar wavelet variance ν against its averaging time 2m/f. The right-hand scale "
                    "reads the same points as Allan deviation √(2ν), whose own averaging time m/f "
                    "is half of the one below. ";
  if (std::isfinite(words.confidence) && words.confidence > 0.0) {
    out += "Shaded: " + percent(words.confidence) + " confidence. ";
  }
  out += "Residual: measured minus model in standard deviations under the model; grey band ±2 σ.";
  const auto untested = [](const ScaleView& scale) { return !scale.tested; };
  if (std::any_of(view.scales.begin(), view.scales.end(), untested)) {
    out += " Hatched: too few degrees of freedom to test.";
  }
  return out;
}

}  // namespace

figure::Figure budget_figure(const BudgetView& view, const BudgetWords& words) {
  figure::Figure out{.title = channel_name(words.channel),
                     .subtitle = words.subtitle,
                     .caption = budget_caption(view, words),
                     .sentence = "Noise budget of " + channel_name(words.channel),
                     .panels = {budget_panel(view, words)},
                     .cursor = true};
  const auto residual = [](const ScaleView& scale) { return std::isfinite(scale.residual); };
  if (std::any_of(view.scales.begin(), view.scales.end(), residual) || view.scales.empty())
    out.panels.push_back(residual_panel(view));
  return out;
}

figure::Figure budget_figure(const v1::FitReport& report) {
  const Verdict found = verdict(report);
  figure::Figure out = budget_figure(
      budget_view(report), {.channel = report.channel(),
                            .unit = report.unit(),
                            .subtitle = std::string(verdict_words(found)) + ": " + facts(report),
                            .confidence = report.confidence(),
                            .mark_misfits = fails(found)});
  if (!report.summary().empty()) out.sentence += ": " + report.summary();
  return out;
}

std::optional<figure::Figure> replicates_figure(const std::vector<ReplicateView>& replicates,
                                                const std::string& channel) {
  Panel panel{.x = {.kind = AxisKind::kLogarithmic, .title = "averaging time, s"},
              .y = {.kind = AxisKind::kCategories}};
  Layer cells{.shape = Shape::kCells, .role = Role::kMeasured};
  for (const ReplicateView& replicate : replicates) {
    std::string name = clean_text(replicate.name);
    if (replicate.samples > 0)
      name = shorten(name, 24) + " · " + count(replicate.samples, Digits::kTypeset) + " samples";
    panel.y.categories.push_back(std::move(name));
    const std::vector<ScaleView>& scales = replicate.scales;
    const auto row = static_cast<double>(panel.y.categories.size() - 1);
    for (std::size_t k = 0; k < scales.size(); ++k) {
      if (!std::isfinite(scales[k].residual)) continue;
      // The outer cells reach as far beyond their scale as on its inner side.
      const double x = scales[k].seconds;
      const double begin = k > 0               ? column_begin(scales, k)
                           : scales.size() > 1 ? x * x / column_end(scales, k)
                                               : x / std::numbers::sqrt2;
      const double end = k + 1 < scales.size() ? column_end(scales, k) : x * x / begin;
      const bool outside = std::abs(scales[k].residual) > kSigmaLimit;
      cells.data.push_back(
          {.x = x,
           .y = row,
           .lower = begin,
           .upper = end,
           .state = outside ? State::kOutside : State::kPlain,
           .sigma = scales[k].residual,
           .words = outside ? signed_sigma(scales[k].residual, Digits::kTypeset) : ""});
    }
  }
  panel.layers = {std::move(cells)};
  return figure::unless_empty(
      {.title = "Residual of each replicate of " + channel_name(channel) + " at each scale",
       .caption = "Residual of each replicate in standard deviations under the model: orange above "
                  "it, blue below; a sign marks those beyond ±2 σ.",
       .panels = {std::move(panel)}});
}

}  // namespace imunoise::report
