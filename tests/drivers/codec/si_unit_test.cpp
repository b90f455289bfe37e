#include "drivers/codec/si_unit.h"

#include <gtest/gtest.h>

#include <limits>
#include <numbers>
#include <set>

namespace imunoise::drivers {
namespace {

TEST(SiUnit, ConvertsWhatIsKnownAndKeepsTheRest) {
  EXPECT_EQ(si_unit("m/s2").symbol, "m/s^2");
  EXPECT_EQ(si_unit("deg/s").symbol, "rad/s");
  EXPECT_DOUBLE_EQ(si_unit("deg/s").scale, std::numbers::pi / 180.0);
  EXPECT_EQ(si_unit("degC").symbol, "K");
  EXPECT_EQ(si_unit("degC").offset, 273.15);
  for (const char* const other : {"a.u.", "deg", "", "1", "m"}) {
    EXPECT_EQ(si_unit(other).symbol, other);
    EXPECT_EQ(si_unit(other).scale, 1.0);
  }
}

TEST(SiUnit, OnlyFiniteValuesEnterASample) {
  DecodedSample sample;
  Refusals refused;
  const SiUnit unit = si_unit("m/s^2");
  for (const double number :
       {1.0, std::numeric_limits<double>::infinity(), std::numeric_limits<double>::quiet_NaN()}) {
    append_value(sample, "x", unit, number, refused);
  }
  EXPECT_EQ(sample.values.size(), 1U);
  EXPECT_EQ(refused.count(Refusal::kNotFinite), 2U);
}

TEST(Refusals, HaveWordsOfTheirOwn) {
  std::set<std::string_view> names;
  for (std::size_t i = 0; i < kRefusals; ++i) {
    names.insert(name_of(static_cast<Refusal>(i)));
    EXPECT_FALSE(meaning_of(static_cast<Refusal>(i)).empty());
  }
  EXPECT_EQ(names.size(), kRefusals);
  EXPECT_EQ(name_of(Refusal::kRemoteFrame), "remote_frame");  // the last: the table is aligned
}

}  // namespace
}  // namespace imunoise::drivers
