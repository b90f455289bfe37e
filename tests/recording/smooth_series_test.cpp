// A series that is filtered looks in some ways like one whose samples are repeated.

#include <fmt/format.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <random>
#include <string>
#include <vector>

#include "tests/recording/files.h"

namespace imunoise::recording {
namespace {

class SmoothSeries : public FileTest {};

// Neighbours of a filtered series are the same coarse number far more often than samples apart, and
// no sample is repeated.
TEST_F(SmoothSeries, AFilteredSeriesInCoarseNumbersRepeatsNothing) {
  constexpr int kRows = 4000;
  constexpr int kTaps = 20;
  std::mt19937 random(5);
  std::normal_distribution<double> normal;
  std::vector<double> raw(kRows + kTaps);
  for (double& one : raw) one = normal(random);
  const auto filtered = [&](int i) {
    double sum = 0.0;
    for (int j = 0; j < kTaps; ++j)
      sum += raw[static_cast<std::size_t>(i + j)] * (1 + std::min(j, kTaps - 1 - j));
    return std::round(sum / 4.0);
  };
  std::string table = "t,wx [rad/s]\n";
  for (int i = 0; i < kRows; ++i) table += fmt::format("{:.2f},{}\n", 0.01 * i, filtered(i));
  const auto got = import_one(write("smooth.csv", table));
  ASSERT_TRUE(got) << got.error().message;
  for (const Finding& found : got->front().preflight->findings)
    EXPECT_EQ(found.text.find("repeat"), std::string::npos) << found.text;
}

}  // namespace
}  // namespace imunoise::recording
