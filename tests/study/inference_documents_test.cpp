// The documents of the commands of analysis, on the page and in the terminal.

#include "study/report/documents/inference_documents.h"

#include <gtest/gtest.h>

#include <limits>
#include <sstream>

#include "study/figure/svg.h"
#include "study/report/documents/datasheet_document.h"
#include "study/words/text.h"
#include "tests/study/markup_check.h"

namespace imunoise::report {
namespace {

constexpr const char* kHostileName = "<img src=x onerror=alert(1)> \x1b[31m & \u202E \"'";

v1::TestResult test_result(int degrees, bool rejected) {
  v1::TestResult out;
  out.set_statistic(71.01);
  out.set_degrees_of_freedom(degrees);
  if (degrees > 0) out.set_p_value(rejected ? 1e-7 : 0.51);
  out.set_rejected(rejected);
  return out;
}

v1::StationarityReports stationarity(const v1::TestResult& misfit, const v1::TestResult& differ) {
  v1::StationarityReports out;
  v1::StationarityReport& one = *out.add_channels();
  one.set_channel("gyro_x");
  *one.mutable_misfit() = misfit;
  *one.mutable_heterogeneity() = differ;
  return out;
}

void add_spread(v1::StationarityReport& to, const std::string& term, double relative) {
  v1::ParameterSpread& one = *to.add_spread();
  one.set_term(term);
  one.set_parameter("sigma2");
  one.set_unit("(rad/s)²");
  one.set_relative(relative);
  one.set_relative_upper(2.0 * relative);
  one.set_moves(relative > 0.1);
}

void add_candidate(v1::ChoiceReport& to, const std::string& model, double merit) {
  v1::CandidateModel& one = *to.add_candidates();
  one.set_model(model);
  one.set_merit(merit);
  one.set_merit_lower(0.9 * merit);
  one.set_merit_upper(1.1 * merit);
  one.set_excess(merit - 1.0);
  one.set_excess_lower(0.9 * merit - 1.0);
  one.set_excess_upper(1.1 * merit - 1.0);
  one.set_verdict(to.candidates_size() == 1 ? v1::selected : v1::not_appropriate);
}

v1::DynamicReports dynamic(const std::string& name) {
  v1::DynamicReports out;
  v1::DynamicReport& one = *out.add_channels();
  one.set_channel(name);
  one.set_covariate(name);
  one.set_covariate_unit(name);
  one.set_summary(name);
  one.add_notes(name);
  one.add_trends()->set_term(name);
  one.add_bins()->set_model(name);
  v1::DynamicQuantity& walk = *one.add_quantities();
  walk.set_term(name);
  walk.set_symbol("N");
  walk.set_unit(name);
  walk.set_varies(true);
  double covariate = 30.0;
  for (const double value : {0.146, 0.0, -1.0, std::numeric_limits<double>::quiet_NaN(),
                             std::numeric_limits<double>::infinity(), 0.439}) {
    for (auto* const points :
         {walk.mutable_curve(), walk.mutable_bins(), walk.mutable_separate()}) {
      v1::CovariatePoint& point = *points->Add();
      point.set_covariate(covariate);
      point.set_value(value);
      if (value < 0.4) point.set_lower(0.9 * value);
      point.set_upper(value > 0.4 ? std::numeric_limits<double>::infinity() : 1.1 * value);
    }
    covariate += 60.0;
  }
  return out;
}

v1::ArrayReport hostile_array() {
  v1::ArrayReport out;
  out.add_sensors(kHostileName);
  for (int i = 0; i < 30; ++i) {  // more than there is room for
    v1::SensorPair& pair = *out.add_pairs();
    pair.set_first(kHostileName);
    pair.set_second("b");
    pair.set_dependent(i % 2 == 0);
    for (const double covariance : {0.5, -0.5, 1e9, 0.0}) {
      v1::CrossScale& scale = *pair.add_scales();
      scale.set_tau_s(0.01 * pair.scales_size());
      scale.set_covariance(covariance);
      scale.set_lower(covariance - 0.1);
      scale.set_upper(covariance + 0.1);
      scale.set_unit(1.0);
    }
  }
  return out;
}

v1::MixedReport hostile_mixed() {
  v1::MixedReport out;
  out.set_unit(kHostileName);
  out.set_summary(kHostileName);
  v1::RegressionCoefficient& one = *out.add_coefficients();
  one.set_regressor(kHostileName);
  one.set_unit(kHostileName);
  one.mutable_gls()->set_value(-1e300);
  out.add_constants()->set_series(kHostileName);
  out.add_explained()->add_terms()->set_term(kHostileName);
  out.add_explained()->set_sensor(kHostileName);
  return out;
}

v1::FaultReport hostile_faults() {
  v1::FaultReport out;
  out.set_unit("rad/s");
  for (const char* kind : {"step", "noisy", "stuck"}) {
    v1::SensorFault& fault = *out.add_faults();
    fault.set_kind(kind);
    fault.add_sensors(kHostileName);
    fault.add_sensors("b");
    fault.set_replicate(kHostileName);
    fault.set_onset_s(1e9);
  }
  for (const double high : {1.0, 0.0}) {
    v1::ParityTrace& trace = *out.add_traces();
    trace.set_replicate(kHostileName);
    trace.set_sensor(kHostileName);
    trace.set_step_s(0.1);
    trace.add_low(0.0);
    trace.add_high(high);
  }
  out.add_stuck_rules()->set_sensor(kHostileName);
  return out;
}

// Everything that files and people can put in, and numbers that no axis holds.
std::vector<Document> troubled(Digits digits) {
  v1::StationarityReports tests = stationarity(test_result(72, true), test_result(0, false));
  v1::StationarityReport& one = *tests.mutable_channels(0);
  one.set_channel(kHostileName);
  one.set_summary(kHostileName);
  one.add_notes(kHostileName);
  for (const double relative : {0.3, 0.0, -1.0, std::numeric_limits<double>::quiet_NaN(),
                                std::numeric_limits<double>::infinity()}) {
    add_spread(one, kHostileName, relative);
  }
  tests.add_channels();
  v1::ChoiceReports choices;
  v1::ChoiceReport& choice = *choices.add_channels();
  choice.set_channel(kHostileName);
  for (const double merit : {1.0, 0.0, 75942.0, std::numeric_limits<double>::quiet_NaN()}) {
    add_candidate(choice, kHostileName, merit);
  }
  choices.add_channels();
  v1::DynamicReports covariates = dynamic(kHostileName);
  covariates.add_channels();
  return {document(tests, digits),
          document(choices, digits),
          document(covariates, digits),
          document(hostile_array(), digits),
          document(hostile_faults(), digits),
          document(hostile_mixed(), digits),
          document(v1::StationarityReports{}, digits),
          document(v1::ChoiceReports{}, digits),
          document(v1::DynamicReports{}, digits),
          document(v1::ArrayReport{}, digits),
          document(v1::FaultReport{}, digits),
          document(v1::MixedReport{}, digits)};
}

TEST(InferenceDocuments, PagesAreWellFormedAndNamesStayText) {
  for (const Document& one : troubled(Digits::kTypeset)) {
    const std::string page = html_page(one);
    EXPECT_EQ(read_markup(page).error, "");
    EXPECT_EQ(page.find("<img"), std::string::npos);
    EXPECT_EQ(page.find('\x1b'), std::string::npos);
    EXPECT_EQ(page.find("\u202E"), std::string::npos);
  }
}

TEST(InferenceDocuments, NoiseOverACovariateIsDrawnForDeskPhoneAndTerminal) {
  const v1::DynamicReports report = dynamic("gyro");
  const Section shown = document(report, Digits::kPlain).sections.at(0);
  ASSERT_EQ(shown.figures.size(), 1U);
  for (const double width : {920.0, 388.0}) {
    const std::string svg = figure::svg(shown.figures[0], {figure::SvgVariant::kInline, width});
    EXPECT_EQ(read_markup(svg).error, "");
    std::size_t circles = 0;  // a value that is not finite or below zero has no place
    for (auto at = svg.find("<circle"); at != std::string::npos; at = svg.find("<circle", at + 1)) {
      ++circles;
    }
    EXPECT_EQ(circles, 3U);
    EXPECT_EQ(svg.find("nan"), std::string::npos);
    EXPECT_NE(svg.find("N of gyro, gyro"), std::string::npos);
  }
  const std::string words = text(document(report, Digits::kPlain), {100, false, true});
  EXPECT_NE(words.find("0.146 (0.131 … 0.161)"), std::string::npos) << words;
}

TEST(InferenceDocuments, FaultsAreMarkedWhereTheyAre) {
  const Document shown = document(hostile_faults(), Digits::kTypeset);
  ASSERT_EQ(shown.sections[0].figures.size(), 1U) << "one a replicate";
  for (const char* kind : {">step<", ">noisy<", ">stuck<"}) {
    EXPECT_NE(figure::svg(shown.sections[0].figures[0]).find(kind), std::string::npos) << kind;
  }
  v1::FaultReport quiet;
  EXPECT_EQ(document(quiet, Digits::kPlain).sections[0].badge, "not watched");
  quiet.set_watched_s(60.0);
  EXPECT_EQ(document(quiet, Digits::kPlain).sections[0].badge, "no fault");
}

// A figure that was not seen is not met.
TEST(InferenceDocuments, ADataSheetIsMetByWhatWasSeen) {
  v1::DatasheetReports all;
  v1::DatasheetReport& report = *all.add_channels();
  report.mutable_measured();
  const auto badge = [&] { return document(all, Digits::kPlain).sections.at(0).badge; };
  report.add_figures()->set_verdict("not seen");
  EXPECT_EQ(badge(), "not seen");
  report.add_figures()->set_verdict("met");
  EXPECT_EQ(badge(), "met");
  report.add_figures()->set_verdict("missed");
  EXPECT_EQ(badge(), "missed");
}

TEST(InferenceDocuments, CrossCovariancesOfManyPairsShowThoseThatShareNoise) {
  const Document shown = document(hostile_array(), Digits::kTypeset);
  ASSERT_EQ(shown.sections[0].figures.size(), 1U);
  EXPECT_NE(shown.sections[0].figures[0].caption.find("15 of 30 pairs"), std::string::npos);
}

TEST(InferenceDocuments, NoLineIsWiderThanTheTerminal) {
  for (const Document& one : troubled(Digits::kPlain)) {
    for (const int width : {60, 80, 120}) {
      std::istringstream lines(text(one, {width, false, true}));
      for (std::string line; std::getline(lines, line);) {
        EXPECT_LE(display_width(line), static_cast<std::size_t>(width)) << line;
        EXPECT_EQ(line.find('\x1b'), std::string::npos);
      }
    }
  }
}

v1::Rung rung_with(double unexplained, double waves) {
  v1::Rung out;
  out.set_model("WN + RW");
  out.set_unexplained(unexplained);
  out.set_consequence("The best model.");
  v1::IntegratedError& drift = *out.add_drift();
  drift.set_seconds(100.0);
  drift.set_best(1.0);
  v1::ErrorView& view = *out.add_views();
  view.set_view("single_waves");
  view.set_value(waves);
  view.set_floor(6.5);
  view.set_unit("dB");
  view.set_p(waves > 10.0 ? 1e-9 : 0.4);
  view.set_sentence("The strongest wave, at 7 Hz, is 20 dB over the noise.");
  return out;
}

TEST(InferenceDocuments, ADiagnosisShowsHowTheErrorFalls) {
  v1::DiagnosisReports reports;
  v1::DiagnosisReport& report = *reports.add_channels();
  report.set_channel("gyro_x");
  *report.add_ladder() = rung_with(15.3, 20.3);
  *report.add_ladder() = rung_with(1.0, 6.5);
  report.mutable_ladder(1)->set_added("line(f=7)");
  const Document shown = document(reports, Digits{});
  for (const Table& table : shown.sections[0].tables) {
    for (const auto& row : table.rows) EXPECT_EQ(row.size(), table.head.size()) << table.title;
  }
  ASSERT_TRUE(shown.sections[0].panel);
  const std::string words = text(shown);
  for (const char* part : {"15.3", "20.3 dB", "6.5 dB", "single waves", "The best model."})
    EXPECT_NE(words.find(part), std::string::npos) << part;
}

TEST(InferenceDocuments, BadgeSaysWhatWasRejectedAndWhatWasNotAsked) {
  const auto badge = [](const v1::TestResult& misfit, const v1::TestResult& differ) {
    return document(stationarity(misfit, differ), Digits::kPlain).sections.at(0).badge;
  };
  EXPECT_EQ(badge(test_result(72, false), test_result(20, false)), "near-stationary");
  EXPECT_EQ(badge(test_result(72, true), test_result(20, false)), "misfit");
  EXPECT_EQ(badge(test_result(72, false), test_result(20, true)), "parameters differ");
  EXPECT_EQ(badge(test_result(72, true), test_result(20, true)), "misfit, and parameters differ");
  EXPECT_EQ(badge(test_result(72, false), test_result(0, false)), "not tested");
  EXPECT_EQ(badge(test_result(0, false), test_result(20, false)), "not tested");
  EXPECT_EQ(badge(test_result(0, false), test_result(20, true)), "parameters differ");
}

// Eleven sub-models of the default model, the worst of them 1e5 times the noise floor, in 80
// columns.
TEST(InferenceDocuments, NoNumberOfAChoiceIsCut) {
  v1::ChoiceReports choices;
  v1::ChoiceReport& choice = *choices.add_channels();
  for (const double merit : {1.062, 1.38, 18.4, 69.4, 99.4, 100.2, 942.0, 75942.3, 98557.9}) {
    add_candidate(choice, "2*AR1 + WN + RW", merit);
  }
  const std::string shown = text(document(choices, Digits::kPlain), {80, false, true});
  for (const char* number :
       {"1.06 (0.96 … 1.17)", "99 (89 … 109)", "98 (88 … 108)", " 942 ", " 75942 ", " 75941 "}) {
    EXPECT_NE(shown.find(number), std::string::npos) << number << "\n" << shown;
  }
}

}  // namespace
}  // namespace imunoise::report
