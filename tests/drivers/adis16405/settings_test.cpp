// What the user wants, as registers.

#include "drivers/adis16405/settings.h"

#include <gtest/gtest.h>

namespace imunoise::drivers::adis16405 {
namespace {

TEST(Settings, RangesAndFilters) {
  EXPECT_EQ(sensitivity_averaging(300, 2), 0x0402);
  EXPECT_EQ(sensitivity_averaging(150, 2), 0x0202);
  EXPECT_EQ(sensitivity_averaging(75, 7), 0x0107);
  EXPECT_NE(sensitivity_averaging(75, 3).error().message.find("at least 4"), std::string::npos);
  EXPECT_NE(sensitivity_averaging(150, 1).error().message.find("at least 2"), std::string::npos);
}

TEST(Settings, RatesWithinOnePercent) {
  EXPECT_EQ(sample_period({819.2}), 0x0001);
  EXPECT_EQ(sample_period({820.0}), 0x0001);
  EXPECT_EQ(sample_period({102.4}), 0x000f);
  EXPECT_EQ(sample_period({25.6}), 0x003f);   // the fast clock's
  EXPECT_EQ(sample_period({2.03}), 0x0099);   // 52.85 / 26
  EXPECT_EQ(sample_period({1.0}), 0x00b4);    // 52.85 / 53
  EXPECT_EQ(sample_period({0.413}), 0x00ff);  // the slowest
  const std::string message = sample_period({200.0}).error().message;
  EXPECT_NE(message.find("204.8"), std::string::npos) << message;
  EXPECT_NE(sample_period({0.3}).error().message.find("0.412"), std::string::npos);
  EXPECT_FALSE(sample_period({1638.4}));
}

}  // namespace
}  // namespace imunoise::drivers::adis16405
