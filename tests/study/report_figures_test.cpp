#include <gtest/gtest.h>

#include <cmath>

#include "study/figure/label_layout.h"
#include "study/figure/layout.h"
#include "study/figure/scale.h"
#include "study/figure/svg.h"
#include "study/report/figures/budget_figure.h"
#include "tests/study/figure_geometry.h"
#include "tests/study/sample_report.h"

namespace imunoise::report {
namespace {

using figure::AxisKind;
using figure::Scale;
using figure::SvgOptions;
using figure::SvgVariant;
using figure::Tick;

std::string budget_svg(const v1::FitReport& report, const SvgOptions& options = {}) {
  return svg(budget_figure(report), options);
}

std::string replicates_svg(const v1::FitReport& report, const SvgOptions& options) {
  const auto figure = replicates_figure(budget_view(report).replicates, report.channel());
  return figure ? svg(*figure, options) : "";
}

std::vector<v1::FitReport> all_samples() {
  return {good_gyro(),          misfit_gyro(),   bounded_gyro(),  accelerometer(),
          dense_unknown_unit(), hostile_names(), broken_arrays(), v1::FitReport{}};
}

std::vector<SvgOptions> all_options() {
  return {{SvgVariant::kStandalone, 900.0},
          {SvgVariant::kInline, 920.0},
          {SvgVariant::kInline, 388.0},
          {SvgVariant::kInline, 640.0, 360.0}};
}

std::size_t count_class(const Markup& markup, const std::string& css_class) {
  std::size_t n = 0;
  for (const Element& element : markup.elements) {
    const auto found = element.attributes.find("class");
    if (found != element.attributes.end() && found->second == css_class) ++n;
  }
  return n;
}

// The advance widths of DejaVu Sans, the widest font asked for, in em.
TEST(Figures, NamesOfModelsAreNotWiderThanReckoned) {
  EXPECT_GE(figure::text_width("WN + AR1 + RW", 1.0), 8.342);
  EXPECT_GE(figure::text_width("2*AR1 + WN + RW", 1.0), 9.478);
}

TEST(Figures, AreWellFormedAndInsideTheCanvas) {
  for (const v1::FitReport& report : all_samples()) {
    for (const SvgOptions& options : all_options()) {
      for (const std::string& svg :
           {budget_svg(report, options), replicates_svg(report, options)}) {
        if (!svg.empty()) expect_sound(svg, report.channel());
      }
    }
  }
}

TEST(Figures, TextsDoNotOverlapOrLeaveTheCanvas) {
  for (const v1::FitReport& report : all_samples()) {
    for (const SvgOptions& options : all_options())
      for (const std::string& svg :
           {budget_svg(report, options), replicates_svg(report, options)}) {
        if (!svg.empty()) expect_texts_apart(svg, report.channel());
      }
  }
}

TEST(Figures, PointsStandWhereTheirNumbersSay) {
  const v1::FitReport report = good_gyro();
  const BudgetView view = budget_view(report);
  const figure::Figure described = budget_figure(report);
  const figure::Layout layout = figure::layout(described, {});
  const Box& frame = layout.panels.at(0).frame;
  const Scale& variance = layout.panels.at(0).y;
  const Markup markup = read_markup(budget_svg(report));
  std::vector<Point> measured;
  for (const Element& element : markup.elements) {
    if (element.name == "circle" && element.attributes.at("class").starts_with("measured")) {
      measured.push_back({value(element, "cx"), value(element, "cy")});
    }
  }
  measured.erase(measured.begin());  // the key's
  ASSERT_EQ(measured.size(), view.scales.size());
  // Read back from the frame's edges, without the axis class.
  const double log_low = std::log(variance.low());
  const double log_high = std::log(variance.high());
  for (std::size_t k = 0; k < measured.size(); ++k) {
    const double up = (frame.bottom - measured[k].y) / frame.height();
    const double read = std::exp(log_low + up * (log_high - log_low));
    EXPECT_NEAR(read / view.scales[k].measured, 1.0, 0.001);
  }
}

std::vector<std::string> labels(const std::vector<Tick>& ticks) {
  std::vector<std::string> out;
  for (const Tick& tick : ticks) {
    if (tick.major) out.push_back(label_text(tick));
  }
  return out;
}

TEST(Scale, KnownPositions) {
  const Scale decades(AxisKind::kLogarithmic, 0.01, 100.0);
  EXPECT_NEAR(decades(0.01), 0.0, 1e-12);
  EXPECT_NEAR(decades(1.0), 0.5, 1e-12);
  EXPECT_NEAR(decades(100.0), 1.0, 1e-12);
  EXPECT_EQ(labels(decades.ticks(400.0, 40.0, 14.0)),
            (std::vector<std::string>{"0.01", "0.1", "1", "10", "100"}));
  const Scale sigma(AxisKind::kSigma, -20.0, 20.0);
  EXPECT_NEAR(sigma(0.0), 0.5, 1e-12);
  EXPECT_NEAR(sigma(20.0), 1.0, 1e-12);
  EXPECT_NEAR(sigma(-20.0), 0.0, 1e-12);
  EXPECT_EQ(labels(sigma.ticks(400.0, 12.0, 14.0)),
            (std::vector<std::string>{"0", "+2", "−2", "+5", "−5", "+10", "−10", "+20", "−20"}));
  const Scale rows(std::vector<std::string>{"a", "b"});
  EXPECT_EQ(rows(0.0), 0.25);
  EXPECT_EQ(rows(1.0), 0.75);
}

TEST(Scale, TicksAreWhatPeopleCountIn) {
  EXPECT_EQ(labels(Scale(AxisKind::kLinear, -0.1, 1.05).ticks(300.0, 60.0, 14.0)),
            (std::vector<std::string>{"0", "0.5", "1"}));
  EXPECT_EQ(labels(Scale(AxisKind::kDuration, 0.0, 290.0).ticks(800.0, 72.0, 14.0)),
            (std::vector<std::string>{"0", "30 s", "60 s", "90 s", "2 min", "2.5 min", "3 min",
                                      "3.5 min", "4 min", "4.5 min"}));
  constexpr double kDay = 86400.0;
  EXPECT_EQ(
      labels(Scale(AxisKind::kTime, 20000.2 * kDay, 20003.1 * kDay).ticks(600.0, 130.0, 14.0)),
      (std::vector<std::string>{"2024-10-05", "2024-10-06", "2024-10-07"}));
  EXPECT_EQ(
      labels(Scale(AxisKind::kTime, 20000.9 * kDay, 20001.2 * kDay).ticks(600.0, 130.0, 14.0)),
      (std::vector<std::string>{"2024-10-04 22:00", "2024-10-05 00:00", "02:00", "04:00"}));
  EXPECT_EQ(labels(Scale(AxisKind::kTime, 20000.0 * kDay + 1.0, 20000.0 * kDay + 100.0)
                       .ticks(600.0, 130.0, 14.0)),
            (std::vector<std::string>{"2024-10-04 00:00:30", "00:01:00", "00:01:30"}));
  EXPECT_EQ(
      labels(Scale(AxisKind::kTime, 20000.0 * kDay, 20400.0 * kDay).ticks(800.0, 130.0, 14.0)),
      (std::vector<std::string>{"2025-01", "2025-04", "2025-07", "2025-10"}));
  EXPECT_EQ(labels(Scale(AxisKind::kTime, 0.0, 20000.0 * kDay).ticks(800.0, 130.0, 14.0)),
            (std::vector<std::string>{"1970", "1980", "1990", "2000", "2010", "2020"}));
  EXPECT_EQ(labels(Scale(AxisKind::kLinear, 0.95e-14, 1.05e-14).ticks(300.0, 72.0, 14.0)),
            (std::vector<std::string>{"9.5×10⁻¹⁵", "1.00×10⁻¹⁴", "1.05×10⁻¹⁴"}));
  // Less than a decade is read in round steps.
  EXPECT_EQ(labels(Scale(AxisKind::kLogarithmic, 0.95, 1.3).ticks(400.0, 60.0, 14.0)),
            (std::vector<std::string>{"1", "1.1", "1.2", "1.3"}));
}

TEST(Scale, HasNoPlaceForWhatHasNoLogarithm) {
  for (const double x : {0.0, -1.0, std::nan(""), double{INFINITY}, 1e300})
    EXPECT_FALSE(has_place(AxisKind::kLogarithmic, x)) << x;
  EXPECT_TRUE(has_place(AxisKind::kLogarithmic, 3.0));
  EXPECT_TRUE(has_place(AxisKind::kLinear, -1.0));
}

TEST(Figures, MarkTheMisfitOnlyWhenTheTestFails) {
  const Markup misfit = read_markup(budget_svg(misfit_gyro()));
  EXPECT_EQ(count_class(misfit, "misfit"), 1U);
  EXPECT_EQ(count_class(misfit, "residual outside"), 2U);
  EXPECT_EQ(count_class(read_markup(budget_svg(good_gyro())), "misfit"), 0U);
}

TEST(Figures, ATermAtZeroIsSaidNotDrawn) {
  const std::string svg = budget_svg(bounded_gyro());
  EXPECT_NE(svg.find("too small to draw: RW"), std::string::npos);
  EXPECT_EQ(svg.find("<path class=\"term term-2"), std::string::npos);
  EXPECT_EQ(budget_svg(good_gyro()).find("too small to draw"), std::string::npos);
}

TEST(Figures, PaperHasItsOwnColoursAndNoScript) {
  const std::string svg = budget_svg(good_gyro());
  EXPECT_EQ(svg.find("var("), std::string::npos);
  EXPECT_EQ(svg.find("<script"), std::string::npos);
  EXPECT_EQ(svg.find("class=\"column\""), std::string::npos);
  EXPECT_NE(svg.find("#1259a6"), std::string::npos);  // the model's blue
  const std::string page = budget_svg(good_gyro(), {SvgVariant::kInline, 900.0});
  EXPECT_EQ(page.find("<style"), std::string::npos);
  EXPECT_NE(page.find("data-index=\"17\""), std::string::npos);
}

TEST(Labels, CrowdedCurvesKeepTheirNamesApart) {
  const Box frame{0.0, 0.0, 400.0, 300.0};
  std::vector<std::vector<Point>> curves;
  std::vector<std::string> names;
  for (int i = 0; i < 6; ++i) {
    curves.push_back({{0.0, 150.0 + i}, {400.0, 150.0 + i}});
    names.push_back("TERM" + std::to_string(i));
  }
  const auto labels = figure::place_labels(curves, names, {}, frame, 12.0);
  ASSERT_EQ(labels.size(), 6U);
  for (std::size_t i = 0; i < labels.size(); ++i) {
    EXPECT_TRUE(frame.contains(labels[i].box));
    for (std::size_t j = 0; j < i; ++j) EXPECT_FALSE(labels[i].box.overlaps(labels[j].box));
  }
}

}  // namespace
}  // namespace imunoise::report
