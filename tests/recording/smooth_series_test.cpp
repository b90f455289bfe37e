// A series that is filtered looks in some ways like one whose samples are repeated.

#include <fmt/format.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <numbers>
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

// White noise behind a filter of second order, the bilinear transform of Butterworth's, whose
// cut-off is `part` of the rate. A walk and a slow Markov process are no filters.
TEST_F(SmoothSeries, AFilterIsToldHoweverLowItIs) {
  constexpr int kRows = 20'000;
  const auto told = [&](const char* name, const std::vector<double>& values) {
    std::string table = "t,wx [rad/s]\n";
    for (int i = 0; i < kRows; ++i)
      table += fmt::format("{:.3f},{:.9g}\n", 0.001 * i, values[static_cast<std::size_t>(i)]);
    const auto got = import_one(write(name, table));
    EXPECT_TRUE(got) << got.error().message;
    return std::any_of(
        got->front().preflight->findings.begin(), got->front().preflight->findings.end(),
        [](const Finding& found) { return found.text.find("was filtered") != std::string::npos; });
  };
  std::mt19937 random(6);
  std::normal_distribution<double> normal;
  for (const double part : {0.2, 0.1, 0.04, 0.02}) {
    const double k = std::tan(std::numbers::pi * part);
    const double a = 1.0 + std::numbers::sqrt2 * k + k * k;
    std::vector<double> x(kRows, 0.0);
    std::vector<double> y(kRows, 0.0);
    for (std::size_t i = 2; i < x.size(); ++i) {
      x[i] = normal(random);
      y[i] = (k * k * (x[i] + 2.0 * x[i - 1] + x[i - 2]) - 2.0 * (k * k - 1.0) * y[i - 1] -
              (1.0 - std::numbers::sqrt2 * k + k * k) * y[i - 2]) /
             a;
    }
    EXPECT_TRUE(told("filtered.csv", y)) << part;
  }
  std::vector<double> slow(kRows, 0.0);
  double bias = 0.0;
  double walk = 0.0;
  for (double& one : slow) {
    bias = 0.999 * bias + 0.3 * normal(random);
    walk += 0.1 * normal(random);
    one = normal(random) + bias + walk;
  }
  EXPECT_FALSE(told("slow.csv", slow));
}

}  // namespace
}  // namespace imunoise::recording
