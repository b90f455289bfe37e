#include "core/support/units.h"

#include <gtest/gtest.h>

#include <numbers>
#include <string>

#include "core/support/utf8.h"

namespace imunoise {
namespace {

TEST(Units, ParsesTheSpellingsPeopleUse) {
  for (const char* text : {"deg/s", "°/s", "dps", "degrees/sec", "deg s-1", "deg s^-1", "º/s",
                           "Deg/Sec", "DPS", "degree/s", "deg/second", "°·s⁻¹"}) {
    const Result<Unit> unit = parse_unit(text);
    ASSERT_TRUE(unit) << text << ": " << unit.error().message;
    EXPECT_EQ(unit->quantity, Quantity::kAngularRate) << text;
    EXPECT_DOUBLE_EQ(unit->to_si, 0.017453292519943295) << text;
  }
  for (const char* text : {"m/s^2", "m/s²", "m/s2", "m/s/s", "m s-2", "m/(s^2)", "m·s⁻²"}) {
    const Result<Unit> unit = parse_unit(text);
    ASSERT_TRUE(unit) << text;
    EXPECT_EQ(unit->quantity, Quantity::kAcceleration) << text;
    EXPECT_EQ(unit->to_si, 1.0) << text;
  }
}

TEST(Units, DegreesCelsiusStartAtTheIcePoint) {
  for (const char* text : {"°C", "C", "Celsius", "degree_C", "deg C"}) {
    const Result<Unit> celsius = parse_unit(text);
    ASSERT_TRUE(celsius) << text;
    EXPECT_EQ(celsius->to_si, 1.0);
    EXPECT_EQ(celsius->si_offset, 273.15);
  }
  const Result<Unit> fahrenheit = parse_unit("°F");
  ASSERT_TRUE(fahrenheit);
  EXPECT_NEAR(212.0 * fahrenheit->to_si + fahrenheit->si_offset, 373.15, 1e-9);
  EXPECT_EQ(parse_unit("K")->si_offset, 0.0);
}

TEST(Units, ArbitraryOnesAreNumbersAsTheyAre) {
  for (const char* text : {"1", "a.u."}) {
    const Result<Unit> unit = parse_unit(text);
    ASSERT_TRUE(unit) << text;
    EXPECT_EQ(unit->quantity, Quantity::kUnknown);
    EXPECT_EQ(unit->to_si, 1.0);
  }
}

TEST(Units, MultiplesOfOne) {
  const auto counts = parse_unit("0.0076 deg/s");
  ASSERT_TRUE(counts) << counts.error().message;
  EXPECT_EQ(counts->quantity, Quantity::kAngularRate);
  EXPECT_DOUBLE_EQ(counts->to_si, 0.0076 * std::numbers::pi / 180.0);
  EXPECT_DOUBLE_EQ(parse_unit("1/16384 g").value().to_si, 9.80665 / 16384.0);
  for (const char* const text :
       {"0 deg/s", "-1 deg/s", "nan deg/s", "1/0 g", "2 degC", "2 furlong", "2"})
    EXPECT_FALSE(parse_unit(text)) << text;
}

// Each number before a unit was once taken off by a call within the call before.
TEST(Units, OneFactorIsEnough) {
  EXPECT_FALSE(parse_unit("2 0.5 deg/s"));
  std::string many;
  for (int i = 0; i < 500'000; ++i) many += "1 ";
  const auto unit = parse_unit(many + "deg/s");
  ASSERT_FALSE(unit);
  EXPECT_LT(unit.error().message.size(), 1000U);
  std::string degrees = "x";
  for (int i = 0; i < 100; ++i) degrees += "°";
  EXPECT_TRUE(is_utf8(parse_unit(degrees).error().message));
}

TEST(Units, NamesTheKnownOnesWhenOneIsUnknown) {
  const Result<Unit> unit = parse_unit("furlong");
  ASSERT_FALSE(unit);
  EXPECT_NE(unit.error().message.find("furlong"), std::string::npos);
  EXPECT_NE(unit.error().message.find("rad/s"), std::string::npos);
}

// SCIENCE: the conversions that people get wrong, from first principles.
TEST(Units, DatasheetUnitsOfTheCoefficients) {
  const auto si_per_unit = [](Coefficient c, Quantity q) {
    return 1.0 / coefficient_units(c, q).to_datasheet;
  };
  EXPECT_NEAR(si_per_unit(Coefficient::kRandomWalk, Quantity::kAngularRate), 2.9089e-4, 1e-8);
  EXPECT_NEAR(si_per_unit(Coefficient::kBiasInstability, Quantity::kAngularRate), 4.8481e-6, 1e-10);
  EXPECT_NEAR(si_per_unit(Coefficient::kRateRandomWalk, Quantity::kAngularRate), 8.0802e-8, 1e-12);
  EXPECT_NEAR(si_per_unit(Coefficient::kRandomWalk, Quantity::kAcceleration), 9.80665e-6, 1e-15);
  EXPECT_EQ(coefficient_units(Coefficient::kRandomWalk, Quantity::kAngularRate).datasheet, "°/√h");
  EXPECT_EQ(coefficient_units(Coefficient::kRandomWalk, Quantity::kUnknown).si, "unit/√Hz");
}

}  // namespace
}  // namespace imunoise
