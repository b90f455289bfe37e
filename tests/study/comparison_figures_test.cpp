// The figures of a model beside the data, drawn from numbers that are known.

#include "study/report/figures/comparison_figures.h"

#include <gtest/gtest.h>

#include <cmath>

#include "study/figure/svg.h"
#include "tests/study/figure_geometry.h"

namespace imunoise::report {
namespace {

v1::DiagnosisReport sample() {
  v1::DiagnosisReport out;
  out.set_channel("gyro<x>");
  out.set_unit("rad/s");
  v1::EffectCandidate& line = *out.add_candidates();
  line.set_effect("line");
  line.set_familywise_p(1e-9);
  v1::EffectParameter& frequency = *line.add_parameters();
  frequency.set_name("frequency_hz");
  frequency.set_value(13.7);
  v1::Comparison& compared = *out.mutable_compared_before();
  for (int i = 0; i < 60; ++i) {
    v1::SpectrumPoint& one = *compared.add_spectrum();
    one.set_frequency_hz(0.001 * std::pow(10.0, 0.07 * i));
    one.set_model(1e-8);
    one.set_measured(i == 50 ? 4e-8 : 1.1e-8);
    one.set_lower(0.5 * one.measured());
    one.set_upper(2.0 * one.measured());
    one.set_peak(3.0 * one.measured());
  }
  for (int i = 0; i < 8; ++i) {
    v1::ScaleKurtosis& one = *compared.add_kurtosis();
    one.set_seconds(0.01 * std::pow(2.0, i));
    one.set_excess(i == 0 ? 2.0 : 0.01);
    one.set_error(0.02 * std::pow(1.4, i));
  }
  for (int r = 0; r < 3; ++r) {
    const std::string name = "run" + std::to_string(r) + ".h5";
    v1::ReplicateResidual& replicate = *compared.add_replicates();
    replicate.set_name(name);
    for (int i = 0; i < 16; ++i) {
      v1::TimeStretch& one = *compared.add_times();
      one.set_replicate(name);
      one.set_from(100.0 * i);
      one.set_to(100.0 * (i + 1));
      one.set_sigma(r == 1 && i == 3 ? 8.0 : 0.5);
      replicate.add_scales_s(0.02 * std::pow(2.0, i));
      replicate.add_measured(1e-8);
      replicate.add_residual(0.1 * i);
    }
  }
  for (const auto& [first, second] :
       {std::pair("gyro<x>", "temperature"), std::pair("gyro<x>", "gyro_y"),
        std::pair("temperature", "gyro_y")}) {
    v1::SharedMotion& one = *compared.add_pairs();
    one.set_first(first);
    one.set_second(second);
    one.set_from_hz(0.001);
    one.set_to_hz(0.004);
    one.set_correlation(-0.92);
    one.set_sigma(-14.0);
    one.set_p(1e-12);
  }
  v1::LagCurve& lags = *compared.add_lags();
  lags.set_witness("temperature");
  lags.set_chance_nats(4.0);
  for (int i = -6; i < 6; ++i) {
    const double lag = 5.0 * std::exp2(i < 0 ? -i - 1 : i);
    lags.add_seconds(i < 0 ? -lag : lag);
    lags.add_nats(i == 2 ? 30.0 : 3.0);
  }
  return out;
}

std::string page_svg(const figure::Figure& figure, double width = 920.0) {
  return svg(figure, {figure::SvgVariant::kInline, width});
}

std::size_t count_of_class(const std::string& svg, const std::string& css_class) {
  std::size_t out = 0;
  const std::string wanted = "class=\"" + css_class + "\"";
  for (auto at = svg.find(wanted); at != std::string::npos; at = svg.find(wanted, at + 1)) ++out;
  return out;
}

TEST(ComparisonFigures, AreSoundInEveryWidth) {
  const v1::DiagnosisReport report = sample();
  auto figures = comparison_figures(report, report.compared_before());
  ASSERT_EQ(figures.size(), 5U);
  figures.push_back(*spectrum_figure(report, report.compared_before(), "Spectrum"));
  for (const figure::Figure& one : figures) {
    for (const std::string& svg : {page_svg(one), page_svg(one, 388.0)}) {
      expect_sound(svg, one.title);
      expect_texts_apart(svg, one.title);
      EXPECT_EQ(svg.find("gyro<x>"), std::string::npos);
    }
  }
}

TEST(ComparisonFigures, TheSpectrumMarksWhatDeviatesAndWhatWasTested) {
  const v1::DiagnosisReport report = sample();
  const std::string svg = page_svg(*spectrum_figure(report, report.compared_before(), "Spectrum"));
  expect_sound(svg, "spectrum");
  EXPECT_EQ(count_of_class(svg, "measured outside"), 1U);
  EXPECT_EQ(count_of_class(svg, "measured"), 59U);
  EXPECT_NE(svg.find("13.7 Hz"), std::string::npos);
}

TEST(ComparisonFigures, TheStretchThatDeviatesIsColoured) {
  const v1::DiagnosisReport report = sample();
  const auto figures = comparison_figures(report, report.compared_before());
  EXPECT_EQ(count_of_class(page_svg(figures[1]), "cell plus4"), 1U);
  EXPECT_NE(page_svg(figures[1]).find("+8.0"), std::string::npos);
  EXPECT_EQ(count_of_class(page_svg(figures[3]), "cell minus4"), 3U);
  EXPECT_NE(page_svg(figures[3]).find("-0.92"), std::string::npos);
  EXPECT_NE(page_svg(figures[3]).find("0.0020 Hz"), std::string::npos);  // the middle, however slow
}

TEST(ComparisonFigures, NothingIsDrawnOfNothing) {
  const v1::DiagnosisReport empty;
  EXPECT_TRUE(comparison_figures(empty, empty.compared_before()).empty());
  EXPECT_FALSE(spectrum_figure(empty, empty.compared_before(), ""));
}

TEST(ComparisonFigures, NumbersWithoutAPlaceAreLeftOut) {
  v1::DiagnosisReport report = sample();
  v1::SpectrumPoint& zero = *report.mutable_compared_before()->add_spectrum();
  zero.set_frequency_hz(60.0);
  zero.set_measured(NAN);
  report.mutable_compared_before()->mutable_kurtosis(3)->set_excess(INFINITY);
  expect_sound(page_svg(*spectrum_figure(report, report.compared_before(), "Spectrum")), "zero");
  for (const figure::Figure& one : comparison_figures(report, report.compared_before()))
    expect_sound(page_svg(one), one.title);
}

}  // namespace
}  // namespace imunoise::report
