#include <gtest/gtest.h>

#include <cmath>
#include <numbers>

#include "study/deviation/compare.h"

namespace imunoise::testing {
namespace {

constexpr double kDeg = std::numbers::pi / 180.0;

double value_of(const char* text, Quantity quantity) {
  const auto printed = study::parse_printed(text, quantity);
  if (!printed) ADD_FAILURE() << printed.error().message;
  return printed ? printed->figures.front().value : NAN;
}

// One density in each of its spellings.
TEST(Datasheet, UnitsOfNoiseDensity) {
  const double n = 0.3 * kDeg / 60.0;
  for (const char* const text :
       {"N=0.3 deg/sqrt(h)", "ARW=0.3 °/√h", "n = 0.3 deg/√hr", "N=0.3 deg/rt-hr",
        "N=0.005 dps/sqrt(Hz)", "N=5 mdps/√Hz", "N=0.005 °/s/√Hz", "N=18 deg/h/√Hz",
        "N=18 (deg/h)/sqrt(Hz)", "N=8.726646259971648e-05 rad/s/√Hz", "N=0.005 deg/√s"})
    EXPECT_NEAR(value_of(text, Quantity::kAngularRate), n, 1e-12) << text;
  const double a = 60e-6 * 9.80665;
  for (const char* const text : {"N=60 ug/sqrt(Hz)", "N=60 µg/√Hz", "VRW=0.06 mg/√Hz",
                                 "N=5.88399e-4 m/s²/√Hz", "N=0.03530394 m/s/√h"})
    EXPECT_NEAR(value_of(text, Quantity::kAcceleration), a, 1e-6 * a) << text;
}

TEST(Datasheet, UnitsOfBiasInstabilityAndRandomWalk) {
  EXPECT_NEAR(value_of("B=5 deg/h", Quantity::kAngularRate), 5.0 * kDeg / 3600.0, 1e-12);
  EXPECT_NEAR(value_of("BI=15 ug", Quantity::kAcceleration), 15e-6 * 9.80665, 1e-12);
  const double k = 12.0 * kDeg / 3600.0 / 60.0;
  for (const char* const text :
       {"K=12 deg/h/sqrt(h)", "RRW=12 (°/h)/√h", "K=9.696273622e-07 rad/s²/√Hz", "K=0.2 deg/h/√s"})
    EXPECT_NEAR(value_of(text, Quantity::kAngularRate), k, 1e-9 * k) << text;
}

TEST(Datasheet, RefusesWhatItCannotRead) {
  for (const char* const text :
       {"N=0.3", "N=0.3 deg/h", "B=5 deg/√h", "N=-1 deg/√h", "X=1 deg/h", "N=0.3 ug/√Hz", "",
        "N=1 deg/√h,", "N=1 deg/√h, N=2 deg/√h", "K=1 deg/√h", "N=nan deg/√h"}) {
    const auto printed = study::parse_printed(text, Quantity::kAngularRate);
    EXPECT_FALSE(printed) << text;
  }
  const auto unit = study::parse_printed("N=0.3 deg/h", Quantity::kAngularRate);
  EXPECT_NE(unit.error().message.find("write °/√h or rad/s/√Hz"), std::string::npos)
      << unit.error().message;
}

// A device whose N is 1.5 times the printed one, and whose B is what is printed.
TEST(Datasheet, SaysWhichFigureIsMissedAndByHowMuch) {
  constexpr Hertz kHundred{100.0};
  const auto printed =
      study::parse_printed("N=0.3 deg/sqrt(h), B=12 deg/h", Quantity::kAngularRate).value();
  study::PrintedFigures real = printed;
  real.figures[0].value *= 1.5;
  real.figures[1].value *= 0.8;
  const std::vector<double> x = simulate(study::printed_model(real, kHundred), 1U << 19U, 3, 0);
  study::Series series{"gyro_x", {"a"}, {}};
  series.replicates.emplace_back(std::span(x), kHundred, Quantity::kAngularRate);
  const auto report = study::compare_with_datasheet(series, printed, 0.95);
  ASSERT_TRUE(report) << report.error().message;
  const v1::DatasheetFigure& n = report->figures(0);
  EXPECT_EQ(n.verdict(), "missed");
  EXPECT_NEAR(n.measured() / n.value(), 1.5, 0.02);
  EXPECT_LT(n.lower(), n.measured());
  EXPECT_EQ(report->figures(1).verdict(), "met") << report->ShortDebugString();
  EXPECT_NE(report->summary().find("misses N by "), std::string::npos) << report->summary();
}

// Behind a filter the curve is far below white noise at the shortest times: N was read there, and a
// device that misses it by three times met it.
TEST(Datasheet, AFilterDoesNotMakeAnglesWalkLess) {
  const auto printed =
      study::parse_printed("N=0.1 deg/sqrt(h), B=3 deg/h", Quantity::kAngularRate).value();
  constexpr double kN = 1e-4;  // rad/s/√Hz: 0.344 °/√h
  for (const auto& [rate, cutoff] :
       {std::pair(1000.0, 40.0), std::pair(1000.0, 20.0), std::pair(1000.0, 5.0),
        std::pair(200.0, 40.0), std::pair(400.0, 92.0)}) {
    const Model truth{
        {Term(DigitalFilter{kN * kN * rate, 2.0 * std::numbers::pi * cutoff / rate, 2})}};
    const std::vector<double> x = simulate(truth, 1U << 20U, 4, 0);
    study::Series series{"gyro_x", {"a"}, {}};
    series.replicates.emplace_back(std::span(x), Hertz{rate}, Quantity::kAngularRate);
    const auto report = study::compare_with_datasheet(series, printed, 0.95).value();
    const v1::DatasheetFigure& n = report.figures(0);
    EXPECT_GT(report.figures(1).tau_s(), 1.0 / cutoff) << "B before the hump of the filter";
    EXPECT_EQ(n.verdict(), "missed") << rate << " Hz, " << cutoff << " Hz";
    EXPECT_NEAR(n.measured() / kN, 1.0, 0.05) << rate << " Hz, " << cutoff << " Hz, " << n.tau_s();
  }
}

// The verdicts on a device that is what a sheet says.
std::vector<std::string> verdicts(const char* sheet, const Model& truth, std::uint64_t seed) {
  constexpr Hertz kHundred{100.0};
  const auto printed = study::parse_printed(sheet, Quantity::kAngularRate).value();
  study::Series series{"gyro_x", {}, {}};
  std::vector<std::vector<double>> all;
  for (std::uint32_t k = 0; k < 4; ++k) all.push_back(simulate(truth, 10'000, seed, k));
  for (const std::vector<double>& x : all) {
    series.names.push_back("a");
    series.replicates.emplace_back(std::span(x), kHundred, Quantity::kAngularRate);
  }
  std::vector<std::string> out;
  const auto report = study::compare_with_datasheet(series, printed, 0.95).value();
  for (const v1::DatasheetFigure& one : report.figures()) out.push_back(one.verdict());
  return out;
}

// Each printed term is read where the others are, too: they are no fault of it.
TEST(Datasheet, WhatIsExactlyAsPrintedMeetsIt) {
  constexpr Hertz kHundred{100.0};
  const char* const sheet = "N=1e-4 rad/s/sqrt(Hz), B=2e-4 rad/s, K=1e-4 rad/s^2/sqrt(Hz)";
  const Model truth =
      study::printed_model(study::parse_printed(sheet, Quantity::kAngularRate).value(), kHundred);
  constexpr int kSets = 20;
  int missed = 0;
  for (std::uint64_t seed = 1; seed <= kSets; ++seed) {
    for (const std::string& one : verdicts(sheet, truth, seed)) missed += one == "missed" ? 1 : 0;
  }
  // One in 40 each by chance, of 60: more than 6 happen once in 1,000.
  EXPECT_LE(missed, 6) << "seeds 1 to 20";
}

TEST(Datasheet, WhiteNoiseIsNoRandomWalk) {
  const Model white{{Term(WhiteNoise{1e-6})}};
  for (std::uint64_t seed = 1; seed <= 10; ++seed) {
    for (const char* const sheet : {"K=124 deg/h/sqrt(h)", "K=5 deg/h/sqrt(h)"})
      EXPECT_NE(verdicts(sheet, white, seed).at(0), "missed") << sheet << ", seed " << seed;
  }
}

TEST(Datasheet, ARandomWalkBelowTheOtherNoiseIsNotSeen) {
  constexpr Hertz kHundred{100.0};
  const auto printed =
      study::parse_printed("N=0.3 deg/sqrt(h), K=0.01 deg/h/sqrt(h)", Quantity::kAngularRate)
          .value();
  const std::vector<double> x = simulate(study::printed_model(printed, kHundred), 1U << 16U, 3, 0);
  study::Series series{"gyro_x", {"a"}, {}};
  series.replicates.emplace_back(std::span(x), kHundred, Quantity::kAngularRate);
  const auto report = study::compare_with_datasheet(series, printed, 0.95).value();
  EXPECT_EQ(report.figures(0).verdict(), "met");
  EXPECT_EQ(report.figures(1).verdict(), "not seen");
  EXPECT_NE(report.summary().find("record longer to see K"), std::string::npos);
}

}  // namespace
}  // namespace imunoise::testing
