#include "study/report/figures/comparison_figures.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "study/report/figures/budget_figure.h"
#include "study/words/number.h"

namespace imunoise::report {
namespace {

using figure::AxisKind;
using figure::Datum;
using figure::Figure;
using figure::Layer;
using figure::Panel;
using figure::Role;
using figure::Shape;
using figure::State;

constexpr double kSigmaOutside = 3.0;  // of some dozen dots few deviate by three

State outside_if(bool outside) { return outside ? State::kOutside : State::kPlain; }

std::string density_unit(const std::string& unit) {
  return unit.empty() ? "unit²/Hz" : fmt::format("({})²/Hz", unit);
}

bool is_wave(const v1::EffectCandidate& one) {
  return one.effect() == "line" || one.effect() == "harmonics" || one.effect() == "mains_alias";
}

// Waves that were tested, with what came of it.
Layer tested_waves(const v1::DiagnosisReport& report) {
  Layer out{.shape = Shape::kMarks, .role = Role::kMisfit};
  for (const v1::EffectCandidate& one : report.candidates()) {
    if (!is_wave(one)) continue;
    for (const v1::EffectParameter& parameter : one.parameters()) {
      if (parameter.name() != "frequency_hz") continue;
      const bool taken = std::any_of(out.data.begin(), out.data.end(), [&](const Datum& mark) {
        return std::abs(mark.x - parameter.value()) < 1e-3 * mark.x;
      });
      if (taken) continue;
      const bool real = one.familywise_p() < 0.04;
      out.data.push_back(
          {.x = parameter.value(),
           .state = outside_if(real),
           .words = fmt::format("{:.5g} Hz{}", parameter.value(), real ? "" : " (chance)")});
    }
  }
  return out;
}

// The channels of all pairs, in the order of their first mention.
std::vector<std::string> channels_of(const v1::Comparison& compared) {
  std::vector<std::string> out;
  for (const v1::SharedMotion& one : compared.pairs()) {
    for (const std::string& name : {one.first(), one.second()}) {
      if (std::find(out.begin(), out.end(), name) == out.end()) out.push_back(name);
    }
  }
  return out;
}

Datum pair_cell(const v1::SharedMotion& one, const std::vector<std::string>& names) {
  const auto place = [&](const std::string& name) {
    return static_cast<double>(std::find(names.begin(), names.end(), name) - names.begin());
  };
  // What was to be expected of the strongest of so many places has no colour.
  const double sigma = one.p() < 0.05 ? one.sigma() : 0.0;
  const double middle = std::sqrt(one.from_hz() * one.to_hz());
  std::string words = fmt::format("{:+.2f}", one.correlation());
  if (sigma != 0.0 && names.size() <= 6)
    words += fmt::format(" · {} Hz", number(middle, 2, Digits::kTypeset));
  const double row = std::min(place(one.first()), place(one.second()));
  const double column = std::max(place(one.first()), place(one.second())) - 1.0;
  return {.x = column,
          .y = row,
          .lower = column - 0.5,
          .upper = column + 0.5,
          .state = outside_if(sigma != 0.0),
          .sigma = sigma,
          .words = std::move(words)};
}

// The upper half of a table without its diagonal: rows all channels but the last, columns all but
// the first.
std::optional<Figure> pairs_figure(const v1::Comparison& compared) {
  constexpr std::size_t kMostNamed = 5;  // columns with room for a name
  const std::vector<std::string> names = channels_of(compared);
  if (names.size() < 2) return std::nullopt;
  Panel panel{.x = {.kind = AxisKind::kCategories, .title = "channel"},
              .y = {.kind = AxisKind::kCategories}};
  for (std::size_t i = 0; i < names.size(); ++i) {
    const std::string numbered = fmt::format("{} · {}", i + 1, names[i]);
    const bool short_columns = names.size() > kMostNamed;
    if (i > 0) panel.x.categories.push_back(short_columns ? std::to_string(i + 1) : numbered);
    if (i + 1 < names.size() || short_columns) panel.y.categories.push_back(numbered);
  }
  Layer cells{.shape = Shape::kCells, .role = Role::kMeasured};
  for (const v1::SharedMotion& one : compared.pairs()) {
    if (one.first() != one.second()) cells.data.push_back(pair_cell(one, names));
  }
  panel.layers = {std::move(cells)};
  return figure::unless_empty(
      {.title = "What do the sensors share?",
       .caption =
           "Correlation of each pair of channels in the half octave of frequency where it is most "
           "most significant, written in the cell (with the frequency if there is room). The "
           "first row is the analysed channel without what its model explains. Colour: "
           "certain, "
           "full at six standard deviations; none if not significant among all pairs.",
       .panels = {std::move(panel)}});
}

std::optional<Figure> lag_figure(const v1::LagCurve& curve) {
  Layer late{.shape = Shape::kLine, .role = Role::kModel};
  Layer early{.shape = Shape::kLine, .role = Role::kReplicate};
  for (int i = 0; i < std::min(curve.seconds_size(), curve.nats_size()); ++i) {
    Layer& side = curve.seconds(i) > 0.0 ? late : early;
    side.data.push_back({.x = std::abs(curve.seconds(i)), .y = curve.nats(i)});
  }
  std::reverse(early.data.begin(), early.data.end());
  return figure::unless_empty(
      {.title = fmt::format("Behind {}", curve.witness()),
       .caption = fmt::format(
           "Likelihood that {} explains with a positive lag (thick) and a negative one (thin), "
           "where "
           "it cannot be the cause. Line: exceeded by the best lag of an unrelated channel in 5 % "
           "of the cases.",
           curve.witness()),
       .panels = {{.x = {.kind = AxisKind::kLogarithmic, .title = "lag, s"},
                   .y = {.title = "gain in log-likelihood, nats"},
                   .y_reference = curve.chance_nats(),
                   .layers = {std::move(early), std::move(late)}}}});
}

}  // namespace

std::optional<Figure> kurtosis_figure(const v1::Comparison& compared) {
  Layer band{.shape = Shape::kBand, .role = Role::kChance};
  Layer dots{.shape = Shape::kPoints, .role = Role::kMeasured};
  for (const v1::ScaleKurtosis& one : compared.kurtosis()) {
    const double reach = 2.0 * one.error();
    band.data.push_back({.x = one.seconds(), .lower = -reach, .upper = reach});
    dots.data.push_back({.x = one.seconds(),
                         .y = one.excess(),
                         .state = outside_if(std::abs(one.excess()) > kSigmaOutside * one.error()),
                         .sigma = one.excess() / one.error()});
  }
  return figure::unless_empty(
      {.title = "Is the noise normal at every averaging time?",
       .caption = "Excess kurtosis of the whitened noise. Band: where 19 of 20 values "
                  "lie if it is normal. Outliers show at short averaging times "
                  "and fade; bursts and jumps reach longer ones.",
       .panels = {{.x = {.kind = AxisKind::kLogarithmic, .title = "averaging time, s"},
                   .y = {.title = "excess kurtosis"},
                   .y_reference = 0.0,
                   .layers = {std::move(band), std::move(dots)}}}});
}

std::optional<Figure> times_figure(const v1::Comparison& compared) {
  Panel panel{.x = {.kind = AxisKind::kDuration, .title = "time since the start of the replicate"},
              .y = {.kind = AxisKind::kCategories}};
  Layer cells{.shape = Shape::kCells, .role = Role::kMeasured};
  for (const v1::TimeStretch& one : compared.times()) {
    std::vector<std::string>& rows = panel.y.categories;
    if (rows.empty() || rows.back() != one.replicate()) rows.push_back(one.replicate());
    const bool outside = std::abs(one.sigma()) > kSigmaOutside;
    cells.data.push_back({.x = 0.5 * (one.from() + one.to()),
                          .y = static_cast<double>(rows.size() - 1),
                          .lower = one.from(),
                          .upper = one.to(),
                          .state = outside_if(outside),
                          .sigma = one.sigma(),
                          .words = outside ? signed_sigma(one.sigma(), Digits::kTypeset) : ""});
  }
  panel.layers = {std::move(cells)};
  return figure::unless_empty(
      {.title = "When does the noise change?",
       .caption = "Variance of the whitened noise in stretches of each replicate against "
                  "the whole of it: red is more, blue is less, full colour at six "
                  "standard deviations.",
       .panels = {std::move(panel)}});
}

std::optional<Figure> deviations_figure(const v1::DiagnosisReport& report,
                                        const v1::Comparison& compared) {
  auto out = replicates_figure(replicate_views(compared.replicates()), report.channel());
  if (!out) return std::nullopt;
  out->title = "Which replicate deviates, and at which averaging time?";
  out->caption = "Wavelet variance of each replicate against the model, in standard deviations.";
  return out;
}

std::optional<Figure> spectrum_figure(const v1::DiagnosisReport& report,
                                      const v1::Comparison& compared, const std::string& title) {
  Layer peak{.shape = Shape::kLine, .role = Role::kReplicate, .name = "peak"};
  Layer band{.shape = Shape::kBand, .role = Role::kInterval};
  Layer measured{.shape = Shape::kPoints, .role = Role::kMeasured, .name = "measured"};
  Layer model{.shape = Shape::kLine, .role = Role::kModel, .name = "model"};
  for (const v1::SpectrumPoint& one : compared.spectrum()) {
    const double frequency = one.frequency_hz();
    const bool outside = one.model() < one.lower() || one.model() > one.upper();
    peak.data.push_back({.x = frequency, .y = one.peak()});
    band.data.push_back({.x = frequency, .lower = one.lower(), .upper = one.upper()});
    measured.data.push_back({.x = frequency, .y = one.measured(), .state = outside_if(outside)});
    model.data.push_back({.x = frequency, .y = one.model()});
  }
  return figure::unless_empty(
      {.title = title,
       .caption = "One-sided power spectral density, mean of all replicates. Dots and band: "
                  "measured, with 95 % intervals; orange: the model (thick line) lies outside. "
                  "Thin line: the strongest single frequency in each stretch. Marks: lines that "
                  "were tested.",
       .panels = {{.x = {.kind = AxisKind::kLogarithmic, .title = "frequency, Hz"},
                   .y = {.kind = AxisKind::kLogarithmic, .title = density_unit(report.unit())},
                   .layers = {std::move(band), std::move(peak), std::move(measured),
                              std::move(model), tested_waves(report)}}}});
}

std::vector<Figure> witness_figures(const v1::Comparison& compared) {
  std::vector<Figure> out;
  if (auto pairs = pairs_figure(compared)) out.push_back(std::move(*pairs));
  for (const v1::LagCurve& one : compared.lags()) {
    const bool telling = std::any_of(one.nats().begin(), one.nats().end(),
                                     [&](double nats) { return nats > one.chance_nats(); });
    if (!telling) continue;
    if (auto lags = lag_figure(one)) out.push_back(std::move(*lags));
  }
  return out;
}

std::vector<Figure> comparison_figures(const v1::DiagnosisReport& report,
                                       const v1::Comparison& compared) {
  std::vector<Figure> out;
  const auto add = [&](std::optional<Figure> one) {
    if (one) out.push_back(std::move(*one));
  };
  add(deviations_figure(report, compared));
  add(times_figure(compared));
  add(kurtosis_figure(compared));
  for (Figure& one : witness_figures(compared)) out.push_back(std::move(one));
  return out;
}

}  // namespace imunoise::report
