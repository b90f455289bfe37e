#include <gtest/gtest.h>

#include <cmath>

#include "study/report/budget_layout.h"
#include "study/report/label_layout.h"
#include "study/report/svg_plot.h"
#include "tests/study/figure_geometry.h"
#include "tests/study/sample_report.h"

namespace imunoise::report {
namespace {

std::vector<v1::FitReport> all_samples() {
  return {good_gyro(),          misfit_gyro(),   bounded_gyro(),  accelerometer(),
          dense_unknown_unit(), hostile_names(), broken_arrays(), v1::FitReport{}};
}

std::vector<SvgOptions> all_options() {
  return {{SvgVariant::kStandalone, 900.0, "a"},
          {SvgVariant::kInline, 920.0, "b"},
          {SvgVariant::kInline, 388.0, "c"}};
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
  EXPECT_GE(text_width("WN + AR1 + RW", 1.0), 8.342);
  EXPECT_GE(text_width("2*AR1 + WN + RW", 1.0), 9.478);
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
      expect_texts_apart(budget_svg(report, options), report.channel());
  }
}

TEST(Figures, PointsStandWhereTheirNumbersSay) {
  const v1::FitReport report = good_gyro();
  const BudgetView view = budget_view(report);
  const BudgetLayout layout = budget_layout(view, 900.0, 82.0);
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
  const double log_low = std::log(layout.variance.low());
  const double log_high = std::log(layout.variance.high());
  for (std::size_t k = 0; k < measured.size(); ++k) {
    const double up =
        (layout.budget.bottom - measured[k].y) / (layout.budget.bottom - layout.budget.top);
    const double read = std::exp(log_low + up * (log_high - log_low));
    EXPECT_NEAR(read / view.scales[k].measured, 1.0, 0.001);
  }
}

TEST(Axis, KnownPositions) {
  const LogAxis axis(0.01, 100.0, 0.0, 400.0);
  EXPECT_DOUBLE_EQ(axis(0.01), 0.0);
  EXPECT_NEAR(axis(1.0), 200.0, 1e-9);
  EXPECT_NEAR(axis(100.0), 400.0, 1e-9);
  int major = 0;
  for (const Tick& tick : axis.decade_ticks(40.0)) major += tick.major ? 1 : 0;
  EXPECT_EQ(major, 5);
  const SigmaAxis sigma(20.0, 50.0, 40.0);
  EXPECT_DOUBLE_EQ(sigma(0.0), 50.0);
  EXPECT_NEAR(sigma(20.0), 10.0, 1e-9);
  EXPECT_NEAR(sigma(-20.0), 90.0, 1e-9);
  EXPECT_EQ(sigma.ticks(), (std::vector<double>{0, 2, -2, 5, -5, 10, -10, 20, -20}));
}

TEST(Axis, RangePassesOverWhatHasNoLogarithm) {
  LogRange range;
  for (const double x : {0.0, -1.0, std::nan(""), double{INFINITY}}) range.include(x);
  EXPECT_TRUE(range.empty());
  range.include(3.0);
  EXPECT_EQ(range.low(), 3.0);
  EXPECT_EQ(range.high(), 3.0);
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
  const std::string page = budget_svg(good_gyro(), {SvgVariant::kInline, 900.0, "x"});
  EXPECT_EQ(page.find("<style"), std::string::npos);
  EXPECT_NE(page.find("data-scale=\"17\""), std::string::npos);
}

TEST(Labels, CrowdedCurvesKeepTheirNamesApart) {
  const Box frame{0.0, 0.0, 400.0, 300.0};
  std::vector<std::vector<Point>> curves;
  std::vector<std::string> names;
  for (int i = 0; i < 6; ++i) {
    curves.push_back({{0.0, 150.0 + i}, {400.0, 150.0 + i}});
    names.push_back("TERM" + std::to_string(i));
  }
  const auto labels = place_labels(curves, names, {}, frame, 12.0);
  ASSERT_EQ(labels.size(), 6U);
  for (std::size_t i = 0; i < labels.size(); ++i) {
    EXPECT_TRUE(frame.contains(labels[i].box));
    for (std::size_t j = 0; j < i; ++j) EXPECT_FALSE(labels[i].box.overlaps(labels[j].box));
  }
}

}  // namespace
}  // namespace imunoise::report
