// The documents of calibration and catalogue, on the page and in the terminal.

#include "study/report/documents/catalogue_documents.h"

#include <gtest/gtest.h>

#include "study/figure/svg.h"
#include "study/report/figures/history_figure.h"
#include "study/words/text.h"
#include "tests/study/markup_check.h"

namespace imunoise::report {
namespace {

constexpr const char* kHostile = "<img src=x onerror=alert(1)> \x1b[31m & \u202E \"'";
constexpr std::int64_t kDay = 86'400'000'000'000;  // ns
constexpr std::int64_t kStart = 20'000 * kDay;     // 2024-10-04

v1::ParameterHistory parameter(const std::vector<double>& values) {
  v1::ParameterHistory out;
  out.set_channel("gyro_x");
  out.set_term("WN");
  out.set_parameter("N");
  out.set_title("angle random walk");
  out.set_unit("rad/s/√Hz");
  out.set_datasheet_unit("°/√h");
  out.set_to_datasheet(3437.75);
  for (std::size_t i = 0; i < values.size(); ++i) {
    v1::HistoryPoint& one = *out.add_points();
    one.set_folder("week-" + std::to_string(i));
    one.set_started_ns(kStart + static_cast<std::int64_t>(7 * i) * kDay);
    one.set_value(values[i]);
    one.set_lower(0.99 * values[i]);
    one.set_upper(1.01 * values[i]);
    one.set_compared(true);
  }
  return out;
}

v1::History history(bool alarm) {
  v1::History out;
  out.mutable_device()->set_id("simulated:0042");
  *out.add_parameters() = parameter({2e-4, 2.01e-4, 1.99e-4, alarm ? 3e-4 : 2e-4});
  v1::DriftReport& drift = *out.mutable_parameters(0)->mutable_drift();
  drift.set_earlier(3);
  drift.set_change(alarm ? 0.5 : 0.0);
  drift.set_p_value(alarm ? 1e-6 : 0.9);
  drift.set_expected_lower(1.9e-4);
  drift.set_expected_upper(2.1e-4);
  drift.set_alarm(alarm);
  drift.set_newest_alarm(alarm);
  out.set_alarm(alarm);
  return out;
}

std::size_t count_of(const std::string& svg, const std::string& words) {
  std::size_t out = 0;
  for (std::size_t at = svg.find(words); at != std::string::npos; at = svg.find(words, at + 1))
    ++out;
  return out;
}

TEST(HistoryChart, HasADotForEachCalibrationAndAccusesTheNewest) {
  const auto quiet = history_figure(history(false).parameters(0));
  ASSERT_TRUE(quiet);
  EXPECT_EQ(quiet->title, "gyro_x: angle random walk of WN");
  for (const double width : {920.0, 388.0}) {
    const std::string svg = figure::svg(*quiet, {figure::SvgVariant::kInline, width});
    EXPECT_EQ(read_markup(svg).error, "");
    EXPECT_EQ(count_of(svg, "<circle"), 4U);
    EXPECT_EQ(count_of(svg, "class=\"whisker\""), 4U);
    EXPECT_EQ(count_of(svg, "class=\"band\""), 1U);
    EXPECT_EQ(count_of(svg, "outside"), 0U);
    EXPECT_NE(svg.find("2024-10-"), std::string::npos) << "days on the axis";
    EXPECT_NE(svg.find("0.7"), std::string::npos) << "in the datasheet's unit";
  }
  const auto alarm = history_figure(history(true).parameters(0));
  EXPECT_EQ(count_of(figure::svg(*alarm, {figure::SvgVariant::kInline}), "measured outside"), 1U);
}

TEST(HistoryChart, WideIntervalsDoNotFlattenTheValues) {
  v1::ParameterHistory wide = parameter({2e-4, 2.1e-4, 1.9e-4});
  wide.mutable_points(1)->set_upper(1.0);
  wide.mutable_points(2)->clear_upper();
  wide.mutable_points(2)->clear_lower();
  const Markup svg =
      read_markup(figure::svg(*history_figure(wide), {figure::SvgVariant::kInline, 920.0}));
  ASSERT_EQ(svg.error, "");
  double highest = 1e9;
  double lowest = -1e9;
  for (const Element& one : svg.elements) {
    if (one.name != "circle") continue;
    highest = std::min(highest, std::stod(one.attributes.at("cy")));
    lowest = std::max(lowest, std::stod(one.attributes.at("cy")));
  }
  EXPECT_GT(lowest - highest, 40.0) << "px between the largest and the smallest value";
}

TEST(HistoryChart, OneDayIsNoHistory) {
  EXPECT_FALSE(history_figure(parameter({2e-4})));
  v1::ParameterHistory at_once = parameter({2e-4, 3e-4});
  at_once.mutable_points(1)->set_started_ns(kStart);
  EXPECT_FALSE(history_figure(at_once));
  EXPECT_TRUE(history_figure(parameter({2e-4, 2e-4}))) << "values that are all alike";
}

TEST(CatalogueDocuments, SayWhatDrifts) {
  const std::string words = text(document(history(true), Digits::kPlain));
  EXPECT_NE(words.find("CHANGED"), std::string::npos) << words;
  EXPECT_NE(words.find("+50 %"), std::string::npos) << words;
  EXPECT_NE(words.find("2024-10-04 00:00"), std::string::npos) << words;
  EXPECT_EQ(text(document(history(false), Digits::kPlain)).find("CHANGED"), std::string::npos);
}

TEST(CatalogueDocuments, ABoundIsToldAsOne) {
  v1::History bounded = history(false);
  bounded.mutable_parameters(0)->mutable_points(3)->set_lower(0.0);
  EXPECT_NE(text(document(bounded, Digits::kPlain)).find("at most"), std::string::npos);
}

TEST(CatalogueDocuments, ACalibrationSaysHowDevicesWereJoined) {
  v1::Calibration calibration;
  v1::ArrayCalibration& array = *calibration.add_arrays();
  array.add_channels("left/imu/gyro_x");
  array.add_channels("right/imu/gyro_x");
  EXPECT_EQ(text(document(calibration, Digits::kPlain)).find("together"), std::string::npos);
  array.mutable_join()->set_seconds(90.0);
  v1::JoinedStream& right = *array.mutable_join()->add_streams();
  right.set_device("right");
  right.set_rate_hz(819.2);
  right.set_clock_ppm(-41.7);
  right.set_seconds(120.0);
  right.set_averaged(8);
  right.set_dropped(23);
  v1::CalibrationTrouble& trouble = *array.add_troubles();
  trouble.set_step("join");
  trouble.set_message("mti/imu: not joined: rates differ");
  const std::string words = text(document(calibration, Digits::kPlain));
  for (const char* const part : {"90 s together", "819.2 Hz", "-42 ppm", "2 min", "8 samples",
                                 "23 samples", "join: mti/imu: not joined: rates differ"}) {
    EXPECT_NE(words.find(part), std::string::npos) << part << "\n" << words;
  }
}

TEST(CatalogueDocuments, ForeignTextIsHarmless) {
  v1::Calibration calibration;
  calibration.set_summary(kHostile);
  v1::ChannelCalibration& channel = *calibration.add_channels();
  channel.set_channel(kHostile);
  v1::CalibrationTrouble& trouble = *channel.add_troubles();
  trouble.set_step("fit");
  trouble.set_message(kHostile);
  calibration.add_arrays()->add_channels(kHostile);
  calibration.mutable_arrays(0)->mutable_join()->add_streams()->set_device(kHostile);
  v1::RecordingList recordings;
  recordings.set_root(kHostile);
  recordings.add_recordings()->set_folder(kHostile);
  recordings.mutable_recordings(0)->set_trouble(kHostile);
  v1::CalibrationList calibrations;
  calibrations.add_calibrations()->set_folder(kHostile);
  calibrations.mutable_calibrations(0)->set_summary(kHostile);
  v1::History named = history(true);
  named.mutable_parameters(0)->set_channel(kHostile);
  named.mutable_parameters(0)->set_datasheet_unit(kHostile);
  named.mutable_parameters(0)->mutable_points(0)->set_folder(kHostile);
  for (const Document& one :
       {document(calibration, Digits::kTypeset), document(recordings, Digits::kTypeset),
        document(calibrations, Digits::kTypeset), document(named, Digits::kTypeset)}) {
    const std::string page = html_page(one);
    EXPECT_EQ(read_markup(page).error, "") << one.title;
    EXPECT_EQ(page.find("<img"), std::string::npos) << one.title;
    EXPECT_EQ(page.find('\x1b'), std::string::npos) << one.title;
    EXPECT_EQ(text(one).find('\x1b'), std::string::npos) << one.title;
  }
}

}  // namespace
}  // namespace imunoise::report
