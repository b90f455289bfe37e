// Units of what a witness adds.

#include "core/effect/subject.h"

#include <gtest/gtest.h>

namespace imunoise {
namespace {

TEST(Units, OfQuotientsHaveBrackets) {
  EXPECT_EQ(per("rad/s", "K"), "rad/s/K");
  EXPECT_EQ(per("rad/s", "m/s^2"), "rad/s/(m/s^2)");
  EXPECT_EQ(per("rad/s", "(m/s^2)²"), "rad/s/(m/s^2)²");
  EXPECT_EQ(per("rad/s", "rad/s"), "1");
  EXPECT_EQ(per("1", "rad/s"), "1/(rad/s)");
  EXPECT_EQ(per("m/s^2", "1"), "m/s^2");
  EXPECT_EQ(in_brackets("K"), "K");
}

}  // namespace
}  // namespace imunoise
