// Laws of the tests for drift: what they become where the answer is known in closed form.

#include "core/inference/parameter_history.h"

#include <gtest/gtest.h>

#include <cmath>
#include <vector>

#include "core/support/distributions.h"

namespace imunoise {
namespace {

using Estimates = std::vector<DatedEstimate>;

Estimates dated(const std::vector<double>& values, double variance) {
  Estimates out;
  for (std::size_t i = 0; i < values.size(); ++i)
    out.push_back({static_cast<double>(i), values[i], variance});
  return out;
}

// Two-sided p-value of Student's law: P(F(1, dof) > t²).
double student_p(double t, double dof) { return std::exp(log_f_tail(t * t, 1.0, dof)); }

TEST(ParameterHistory, IsStudentsTestWhereIntervalsAreNarrow) {
  for (const double last : {0.5, 2.0, 9.0}) {
    const Estimates estimates = dated({1.0, -0.5, 0.3, -0.8, last}, 1e-12);
    const double s2 = (1.0 + 0.25 + 0.09 + 0.64) / 3.0;
    const auto got = test_newest(estimates);
    ASSERT_TRUE(got);
    const double exact = student_p(last / std::sqrt(s2 * (1.0 + 0.25)), 3.0);
    EXPECT_NEAR(got->p_value / exact, 1.0, 0.01);
    EXPECT_NEAR(got->change, last, 1e-6);
  }
}

TEST(ParameterHistory, ATrendIsStudentsTestOfASlopeWhereIntervalsAreNarrow) {
  // Times -2 … 2 about their mean: Σt² = 10, Σtx = 9.8 and residuals 0.1·(1, -2, 0, 2, -1).
  const Estimates estimates = dated({-1.86, -1.18, 0.0, 1.18, 1.86}, 1e-12);
  const double slope = (2.0 * 3.72 + 2.36) / 10.0;
  double residuals = 0.0;
  for (std::size_t i = 0; i < 5; ++i) {
    const double fitted = slope * (static_cast<double>(i) - 2.0);
    residuals += std::pow(estimates[i].value - fitted, 2);
  }
  const auto got = test_trend(estimates);
  ASSERT_TRUE(got);
  const double exact = student_p(slope / std::sqrt(residuals / 3.0 / 10.0), 3.0);
  EXPECT_NEAR(got->p_value / exact, 1.0, 0.01);
  EXPECT_NEAR(got->change, 4.0 * slope, 1e-6);
}

TEST(ParameterHistory, TendsToTheNormalTestWhereManyCalibrationsAgree) {
  std::vector<double> values;
  for (int i = 0; i < 400; ++i) values.push_back(i % 2 == 0 ? 0.01 : -0.01);  // less than chance
  values.push_back(2.5);
  const auto got = test_newest(dated(values, 1.0));
  ASSERT_TRUE(got);
  EXPECT_NEAR(got->p_value / std::erfc(2.5 / std::sqrt(2.0 * (1.0 + 1.0 / 400))), 1.0, 0.01);
}

TEST(ParameterHistory, AWideIntervalIsNoAlarm) {
  Estimates estimates = dated({0.0, 0.1, -0.1, 0.05, 4.0}, 0.01);
  EXPECT_LT(test_newest(estimates)->p_value, 1e-3);
  estimates.back().variance = 16.0;
  EXPECT_GT(test_newest(estimates)->p_value, 0.3);
}

TEST(ParameterHistory, AnOutlierOfTheHistoryWeighsByItsInterval) {
  Estimates estimates = dated({0.0, 0.1, -0.1, 3.0, 0.05, 1.0}, 0.01);
  const double as_sure = test_newest(estimates)->p_value;
  EXPECT_GT(as_sure, 0.5) << "this device does such things";
  estimates[3].variance = 16.0;
  EXPECT_LT(test_newest(estimates)->p_value, as_sure / 10.0) << "that calibration knew nothing";
}

TEST(ParameterHistory, TheExpectedRangeEndsWhereTheAlarmBegins) {
  const Estimates history = dated({0.3, -0.2, 0.1, 0.4, -0.1}, 0.04);
  for (const double level : {0.05, 1e-3, 1e-5}) {
    const auto range = expected_next(history, 0.09, level);
    ASSERT_TRUE(range);
    for (const double end : {range->lower, range->upper}) {
      Estimates all = history;
      all.push_back({9.0, end, 0.09});
      EXPECT_NEAR(test_newest(all)->p_value / level, 1.0, 1e-6);
    }
    EXPECT_LT(range->lower, range->centre);
    EXPECT_GT(range->upper, range->centre);
  }
}

TEST(ParameterHistory, UnitsDoNotMatter) {
  const Estimates estimates = dated({0.3, -0.2, 0.1, 0.4, 1.5}, 0.04);
  Estimates scaled = estimates;
  for (DatedEstimate& one : scaled)
    one = {86'400.0 * one.time + 1.7e9, 10.0 * one.value - 7.0, 100.0 * one.variance};
  EXPECT_NEAR(test_newest(scaled)->p_value, test_newest(estimates)->p_value, 1e-9);
  EXPECT_NEAR(test_newest(scaled)->change, 10.0 * test_newest(estimates)->change, 1e-8);
  EXPECT_NEAR(test_trend(scaled)->p_value, test_trend(estimates)->p_value, 1e-6);
  EXPECT_NEAR(test_trend(scaled)->change, 10.0 * test_trend(estimates)->change, 1e-6);
}

TEST(ParameterHistory, AShortHistoryIsNotTested) {
  const Estimates three = dated({0.0, 0.1, 5.0}, 0.01);
  EXPECT_FALSE(test_newest(three));
  EXPECT_FALSE(test_trend(three));
  EXPECT_FALSE(expected_next(std::span(three).first(2), 0.01, 0.05));
  Estimates at_once = dated({0.0, 0.1, 0.2, 5.0}, 0.01);
  for (DatedEstimate& one : at_once) one.time = 3.0;
  EXPECT_FALSE(test_trend(at_once));
  EXPECT_TRUE(test_newest(at_once));
}

}  // namespace
}  // namespace imunoise
