// What the report of an array says, from simulated sensors.

#include "study/analysis/arrays/array_series.h"

#include <gtest/gtest.h>

#include "core/model/model.h"

namespace imunoise::study {
namespace {

constexpr Hertz kArrayRate{100.0};

// Independent sensors, a list of replicates each.
struct Simulated {
  std::vector<std::vector<std::vector<double>>> samples;

  std::vector<Series> series() const {
    std::vector<Series> out;
    for (std::size_t i = 0; i < samples.size(); ++i) {
      Series& one = out.emplace_back(Series{"gyro_" + std::to_string(i), {}, {}});
      for (const std::vector<double>& x : samples[i]) {
        one.names.push_back("run" + std::to_string(one.names.size() + 1));
        one.replicates.emplace_back(std::span<const double>(x), kArrayRate, Quantity::kAngularRate);
      }
    }
    return out;
  }
};

std::vector<double> drawn(const std::string& model, std::size_t samples, std::uint32_t number) {
  return simulate(*parse_model(model, kArrayRate), samples, 20261126, number);
}

v1::ArrayReport report_of(const Simulated& simulated, const std::string& model) {
  ArraySeriesOptions options;
  options.model = model;
  auto out = array_series(simulated.series(), options);
  EXPECT_TRUE(out) << out.error().message;
  return out ? *out : v1::ArrayReport{};
}

TEST(ArraySeries, GivesNoProcessMorePowerThanItsSensorHas) {
  const std::string white = "WN(sigma2=1)";
  const Simulated three{{{drawn(white, 4000, 21), drawn(white, 4000, 22)},
                         {drawn(white, 4000, 23), drawn(white, 4000, 24)},
                         {drawn(white, 4000, 25), drawn(white, 4000, 26)}}};
  const v1::ArrayReport report = report_of(three, "AR1 + WN + RW[corr]");
  for (const v1::ArrayParameter& one : report.parameters()) {
    if (one.parameter() != "sigma2" || !one.has_upper()) continue;
    EXPECT_LT(one.upper(), 4.5) << one.term() << " " << one.sensors(0);
  }
}

// The quiet sensor of the first half is the noisy one of the second.
TEST(ArraySeries, GivesThePlainMeanWhereTheBestWeightsAreNoisierOnHeldOutReplicates) {
  const std::string quiet = "WN(sigma2=1)";
  const std::string noisy = "WN(sigma2=9)";
  const Simulated turned{{{drawn(quiet, 4096, 0), drawn(noisy, 2048, 1)},
                          {drawn(noisy, 4096, 2), drawn(quiet, 2048, 3)}}};
  const Simulated same{{{drawn(quiet, 4096, 0), drawn(quiet, 2048, 4)},
                        {drawn(noisy, 4096, 2), drawn(noisy, 2048, 5)}}};
  const v1::VirtualSensor plain = report_of(turned, "WN").virtual_sensor();
  EXPECT_TRUE(plain.plain_mean());
  for (const v1::SensorWeight& one : plain.weights()) EXPECT_EQ(one.weight(), 0.5);
  EXPECT_GT(plain.scale_gains(0).measured(), 1.0);
  const v1::VirtualSensor best = report_of(same, "WN").virtual_sensor();
  EXPECT_FALSE(best.plain_mean());
  EXPECT_NEAR(best.weights(0).weight(), 0.9, 0.03);
  // The held-out replicates are half as long: their last averaging time is not seen.
  EXPECT_TRUE(best.scale_gains(0).has_measured());
  EXPECT_FALSE(best.scale_gains(best.scale_gains_size() - 1).has_measured());
}

// One sensor is quiet at short averaging times, the other at long ones.
TEST(ArraySeries, TradesShortAveragingTimesForLongOnes) {
  const std::string fast = "WN(sigma2=1) + RW(gamma2=1e-8)";
  const std::string slow = "WN(sigma2=0.01) + RW(gamma2=1e-4)";
  const Simulated both{{{drawn(fast, 8192, 20), drawn(fast, 8192, 21)},
                        {drawn(slow, 8192, 22), drawn(slow, 8192, 23)}}};
  const v1::ArrayReport report = report_of(both, "WN + RW");
  ASSERT_EQ(report.trade_offs_size(), report.virtual_sensor().scale_gains_size());
  EXPECT_LT(report.trade_offs(0).weights(0).weight(), 0.1);
  EXPECT_GT(report.trade_offs(report.trade_offs_size() - 1).weights(0).weight(), 0.8);
  EXPECT_TRUE(report.trade_offs(0).scale_gains(0).has_measured());
  EXPECT_LT(report.trade_offs(0).scale_gains(0).measured(), 0.1);
}

TEST(ArraySeries, JudgesNoPairThatTheModelDoesNotFit) {
  const std::string slow = "WN(sigma2=1) + AR1(sigma2=0.01, phi=0.99)";
  const Simulated sensors{
      {{drawn(slow, 4096, 10)}, {drawn(slow, 4096, 11)}, {drawn("WN(sigma2=1)", 4096, 12)}}};
  const v1::ArrayReport report = report_of(sensors, "WN");
  ASSERT_EQ(report.sensor_fits_size(), 3);
  EXPECT_FALSE(report.sensor_fits(0).fits());
  EXPECT_FALSE(report.sensor_fits(1).fits());
  EXPECT_TRUE(report.sensor_fits(2).fits());
  for (const v1::SensorPair& pair : report.pairs()) {
    EXPECT_TRUE(pair.withheld());
    EXPECT_FALSE(pair.dependent());
  }
  EXPECT_EQ(report.summary().rfind("The model does not fit gyro_0, gyro_1", 0), 0U)
      << report.summary();
}

}  // namespace
}  // namespace imunoise::study
