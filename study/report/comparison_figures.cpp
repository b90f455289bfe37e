#include "study/report/comparison_figures.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "study/report/svg_plot.h"
#include "study/words/number.h"

namespace imunoise::report {
namespace {

constexpr double kSigmaOutside = 3.0;  // of some dozen dots few deviate by three

std::string density_unit(const std::string& unit) {
  return unit.empty() ? "unit²/Hz" : fmt::format("({})²/Hz", unit);
}

bool is_wave(const v1::EffectCandidate& one) {
  return one.effect() == "line" || one.effect() == "harmonics" || one.effect() == "mains_alias";
}

// Waves that were tested, with what came of it.
std::vector<CurveMark> tested_waves(const v1::DiagnosisReport& report) {
  std::vector<CurveMark> out;
  for (const v1::EffectCandidate& one : report.candidates()) {
    if (!is_wave(one)) continue;
    for (const v1::EffectParameter& parameter : one.parameters()) {
      if (parameter.name() != "frequency_hz") continue;
      const bool taken = std::any_of(out.begin(), out.end(), [&](const CurveMark& mark) {
        return std::abs(mark.x - parameter.value()) < 1e-3 * mark.x;
      });
      if (taken) continue;
      const std::string verdict = one.familywise_p() < 0.04 ? "" : " (chance)";
      out.push_back({parameter.value(), fmt::format("{:.5g} Hz{}", parameter.value(), verdict)});
    }
  }
  return out;
}

std::optional<Figure> kurtosis_figure(const v1::Comparison& compared) {
  Layer band{LayerShape::kBand, "chance", {}};
  Layer dots{LayerShape::kDots, "measured", {}};
  for (const v1::ScaleKurtosis& one : compared.kurtosis()) {
    band.points.push_back({one.seconds(), -2.0 * one.error(), 2.0 * one.error()});
    dots.points.push_back(
        {one.seconds(), one.excess(), 0.0, std::abs(one.excess()) > kSigmaOutside * one.error()});
  }
  return curve_figure({.title = "Is the noise normal at every averaging time?",
                       .caption = "Excess kurtosis of the whitened noise. Band: where nineteen of "
                                  "twenty lie if it is normal. Outliers stand out at short times "
                                  "and fade; bursts and jumps reach longer ones.",
                       .x_title = "averaging time, s",
                       .y_title = "excess kurtosis",
                       .layers = {band, dots},
                       .reference = 0.0});
}

std::optional<Figure> times_figure(const v1::Comparison& compared) {
  HeatMap map{.title = "When does the noise change?",
              .caption =
                  "Variance of the whitened noise in stretches of each replicate against "
                  "the whole of it: red is more, blue is less, full colour at six standard "
                  "deviations.",
              .axis_title = "time since the replicate began",
              .rows = {},
              .columns = {},
              .cells = {}};
  for (const v1::TimeStretch& one : compared.times()) {
    if (map.rows.empty() || map.rows.back() != one.replicate()) {
      map.rows.push_back(one.replicate());
      map.cells.emplace_back();
    }
    const std::string mark =
        std::abs(one.sigma()) > kSigmaOutside ? signed_sigma(one.sigma(), Digits::kTypeset) : "";
    map.cells.back().push_back(HeatCell{one.sigma(), mark});
    if (map.rows.size() == 1) map.columns.push_back(duration(0.5 * (one.from() + one.to())));
  }
  return heat_map(map);
}

std::optional<Figure> pairs_figure(const v1::Comparison& compared) {
  std::vector<std::string> names;
  const auto place = [&](const std::string& name) {
    const auto at = std::find(names.begin(), names.end(), name);
    if (at == names.end()) names.push_back(name);
    return static_cast<std::size_t>(std::find(names.begin(), names.end(), name) - names.begin());
  };
  for (const v1::SharedMotion& one : compared.pairs()) {
    place(one.first());
    place(one.second());
  }
  if (names.empty()) return std::nullopt;
  HeatMap map{.title = "What do the sensors share?",
              .caption =
                  "Correlation of every two channels in the half octave of frequency where it is "
                  "most certain, written in the cell (with the frequency where there is room). The "
                  "first row is the channel under study, less what its model explains. Colour: how "
                  "certain, "
                  "full at six standard deviations; none where chance would do as much somewhere.",
              .axis_title = "channel",
              .rows = {},
              .columns = {},
              .cells = {}};
  for (std::size_t i = 0; i < names.size(); ++i) {
    map.rows.push_back(fmt::format("{} · {}", i + 1, names[i]));
    map.columns.push_back(std::to_string(i + 1));
  }
  map.cells.assign(names.size(), std::vector<std::optional<HeatCell>>(names.size()));
  for (const v1::SharedMotion& one : compared.pairs()) {
    // What was to be expected of the strongest of so many places has no colour.
    const double sigma = one.p() < 0.05 ? one.sigma() : 0.0;
    const double middle = std::sqrt(one.from_hz() * one.to_hz());
    std::string mark = fmt::format("{:+.2f}", one.correlation());
    if (sigma != 0.0 && names.size() <= 6)
      mark += fmt::format(" · {} Hz", number(middle, 2, Digits::kTypeset));
    const std::size_t row = std::min(place(one.first()), place(one.second()));
    const std::size_t column = std::max(place(one.first()), place(one.second()));
    map.cells[row][column] = HeatCell{sigma, mark};
  }
  return heat_map(map);
}

std::optional<Figure> lag_figure(const v1::LagCurve& curve) {
  Layer late{LayerShape::kLine, "model", {}};
  Layer early{LayerShape::kLine, "replicate", {}};
  for (int i = 0; i < std::min(curve.seconds_size(), curve.nats_size()); ++i) {
    Layer& side = curve.seconds(i) > 0.0 ? late : early;
    side.points.push_back({std::abs(curve.seconds(i)), curve.nats(i)});
  }
  std::reverse(early.points.begin(), early.points.end());
  return curve_figure(
      {.title = fmt::format("Behind {}", curve.witness()),
       .caption =
           fmt::format("What {} would explain behind a lag (thick) and ahead of it (thin), where "
                       "it cannot be the cause. The line: what the best lag gains by chance once "
                       "in twenty.",
                       curve.witness()),
       .x_title = "lag, s",
       .y_title = "log-likelihood gained, nats",
       .layers = {early, late},
       .reference = curve.chance_nats()});
}

std::optional<Figure> replicates_figure(const v1::DiagnosisReport& report,
                                        const v1::Comparison& compared) {
  v1::FitReport fit;
  fit.set_channel(report.channel());
  fit.set_unit(report.unit());
  *fit.mutable_replicates() = compared.replicates();
  const auto drawn = [&](double width, const char* kind) {
    return of_kind(replicates_svg(fit, {SvgVariant::kInline, width, kind}), kind);
  };
  if (compared.replicates().empty()) return std::nullopt;
  return Figure{"Which replicate deviates, and at which averaging time?", drawn(920.0, "wide"),
                drawn(388.0, "narrow"),
                "Wavelet variance of each replicate against the model, in standard deviations."};
}

}  // namespace

CurveChart spectrum_chart(const v1::DiagnosisReport& report, const v1::Comparison& compared,
                          const std::string& title) {
  Layer peak{LayerShape::kLine, "replicate", {}};
  Layer band{LayerShape::kBand, "band", {}};
  Layer measured{LayerShape::kDots, "measured", {}};
  Layer model{LayerShape::kLine, "model", {}};
  for (const v1::SpectrumPoint& one : compared.spectrum()) {
    peak.points.push_back({one.frequency_hz(), one.peak()});
    band.points.push_back({one.frequency_hz(), one.lower(), one.upper()});
    measured.points.push_back({one.frequency_hz(), one.measured(), 0.0,
                               one.model() < one.lower() || one.model() > one.upper()});
    model.points.push_back({one.frequency_hz(), one.model()});
  }
  return {.title = title,
          .caption =
              "One-sided power spectral density, mean of all replicates. Dots and band: "
              "measured, with 95 % intervals; orange: the model (thick line) lies outside. "
              "Thin line: the strongest single frequency in each stretch. Marks: waves that "
              "were tested.",
          .x_title = "frequency, Hz",
          .y_title = density_unit(report.unit()),
          .log_y = true,
          .layers = {band, peak, measured, model},
          .marks = tested_waves(report)};
}

std::vector<Figure> comparison_figures(const v1::DiagnosisReport& report,
                                       const v1::Comparison& compared) {
  std::vector<Figure> out;
  const auto add = [&](std::optional<Figure> one) {
    if (one) out.push_back(std::move(*one));
  };
  add(replicates_figure(report, compared));
  add(times_figure(compared));
  add(kurtosis_figure(compared));
  add(pairs_figure(compared));
  for (const v1::LagCurve& one : compared.lags()) {
    const bool telling = std::any_of(one.nats().begin(), one.nats().end(),
                                     [&](double nats) { return nats > one.chance_nats(); });
    if (telling) add(lag_figure(one));
  }
  return out;
}

}  // namespace imunoise::report
