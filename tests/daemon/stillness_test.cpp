// A bench that lies still for days raises no alarm, whatever its noise; a knock and a push do.

#include "daemon/acquire/stillness.h"

#include <gtest/gtest.h>

#include <cmath>
#include <functional>

#include "core/model/model.h"
#include "core/model/model_sampler.h"
#include "tests/support/figures_alone.h"

namespace imunoise::acquire {
namespace {

constexpr double kRate = 100.0;  // Hz
constexpr std::size_t kBlock = 1000;

v1::RecordedDevice gyro(const std::string& dtype) {
  v1::RecordedDevice out;
  out.set_name("imu0");
  v1::RecordedStream& stream = *out.add_streams();
  stream.set_name("imu");
  stream.set_rate_hz(kRate);
  v1::RecordedChannel& channel = *stream.add_channels();
  channel.set_name("gyro_x");
  channel.set_dtype(dtype);
  channel.set_units("rad/s");
  return out;
}

// What a sensor delivers at sample i, noise added, where it is moved as told.
using Motion = std::function<double(std::size_t)>;

std::vector<v1::Disturbance> watch(const std::string& model, double hours, std::uint64_t seed,
                                   const Motion& motion = {}, bool counts = false) {
  const v1::RecordedDevice device = gyro(counts ? "<i2" : "<f8");
  StillnessWatch watch(device);
  ModelSampler sampler(parse_model(model, Hertz{kRate}).value(), seed, 1);
  const auto samples = static_cast<std::size_t>(hours * 3600.0 * kRate);
  for (std::size_t i = 0; i < samples; i += kBlock) {
    recording::Block block{0, recording::empty_rows(device.streams(0))};
    std::vector<double> numbers;
    for (std::size_t k = i; k < i + kBlock; ++k) {
      block.rows.host_time.push_back(
          static_cast<std::int64_t>(static_cast<double>(k) * 1e9 / kRate));
      block.rows.flags.push_back(0);
      numbers.push_back(sampler.next() + (motion ? motion(k) : 0.0));
    }
    if (counts) {
      std::vector<std::int16_t> rounded;
      for (const double x : numbers) rounded.push_back(static_cast<std::int16_t>(std::lround(x)));
      block.rows.channels.front() = rounded;
    } else {
      block.rows.channels.front() = numbers;
    }
    block.rows.received = kBlock;
    watch.take(block);
  }
  return watch.disturbances();
}

// Eight hours of each: at ten robust standard deviations chance alone raises none.
TEST(Stillness, NoiseIsNoDisturbance) {
  FIGURES_ALONE();
  for (const char* const model :
       {"WN(sigma2=1e-6)", "RW(gamma2=1e-12)", "WN(sigma2=1e-6) + RW(gamma2=1e-9)",
        "WN(sigma2=1e-6) + AR1(sigma2=1e-8, phi=0.999)", "AR1(sigma2=1e-8, phi=0.99)",
        "QN(q2=1e-6)", "FN(b2=1e-6)"}) {
    const auto seen = watch(model, 8.0, 11);
    EXPECT_TRUE(seen.empty()) << model << ": " << seen.size()
                              << ", first: " << seen.front().ShortDebugString();
  }
}

TEST(Stillness, CoarseCountsAreNoDisturbance) {
  FIGURES_ALONE();
  for (const double sigma2 : {1e-4, 0.04, 0.2, 4.0}) {  // counts squared
    const auto seen = watch(
        "WN(sigma2=" + std::to_string(sigma2) + ")", 8.0, 12, [](std::size_t) { return 7.3; },
        true);
    EXPECT_TRUE(seen.empty()) << sigma2 << ": " << seen.size()
                              << ", first: " << seen.front().ShortDebugString();
  }
}

TEST(Stillness, ADriftWhileWarmingUpIsNone) {
  const auto seen = watch("WN(sigma2=1e-6)", 2.0, 13, [](std::size_t k) {
    return 0.1 * std::exp(-static_cast<double>(k) / kRate / 600.0);
  });
  EXPECT_TRUE(seen.empty()) << seen.size();
}

TEST(Stillness, AKnockIsSeenWhereItWas) {
  constexpr std::size_t kAt = 1234567;  // sample
  const auto seen = watch("WN(sigma2=1e-6)", 5.0, 14, [](std::size_t k) {
    const double t = (static_cast<double>(k) - static_cast<double>(kAt)) / kRate;
    return t < 0.0 ? 0.0 : 0.02 * std::exp(-t / 0.1) * std::sin(2.0 * M_PI * 23.0 * t);
  });
  ASSERT_EQ(seen.size(), 1U);
  const double at = static_cast<double>(kAt) / kRate;
  EXPECT_LE(static_cast<double>(seen[0].begin_ns()) * 1e-9, at);
  EXPECT_GE(static_cast<double>(seen[0].begin_ns()) * 1e-9, at - 1.0);
  EXPECT_GE(static_cast<double>(seen[0].end_ns()) * 1e-9, at);
  EXPECT_EQ(seen[0].channel(), "gyro_x");
  EXPECT_EQ(seen[0].device(), "imu0");
  EXPECT_GT(seen[0].size(), 10.0);
}

TEST(Stillness, APushShiftsTheMean) {
  const auto seen =
      watch("WN(sigma2=1e-6)", 1.0, 15, [](std::size_t k) { return k < 200000 ? 0.0 : 2e-3; });
  ASSERT_EQ(seen.size(), 1U);
  EXPECT_NEAR(static_cast<double>(seen[0].begin_ns()) * 1e-9, 2000.0, 1.01);
  EXPECT_LE(static_cast<double>(seen[0].end_ns()) * 1e-9, 2003.0);
}

TEST(Stillness, ALastingNoiseIsOneEventAndThenUsual) {
  const auto seen = watch("WN(sigma2=1e-6)", 2.0, 16, [](std::size_t k) {
    return k < 200000 ? 0.0 : 0.02 * std::sin(2.0 * M_PI * 0.23 * static_cast<double>(k));
  });
  ASSERT_EQ(seen.size(), 1U);
  EXPECT_NEAR(static_cast<double>(seen[0].end_ns() - seen[0].begin_ns()) * 1e-9, 120.0, 5.0);
}

TEST(Stillness, SamplesAcrossAGapAreNotCompared) {
  const v1::RecordedDevice device = gyro("<f8");
  StillnessWatch watch(device);
  const auto take = [&](double level, bool lost) {
    recording::Block block{0, recording::empty_rows(device.streams(0))};
    for (std::size_t k = 0; k < 6000; ++k) {
      block.rows.host_time.push_back(static_cast<std::int64_t>(k) * 10'000'000);
      block.rows.flags.push_back(lost && k == 0 ? std::uint32_t{recording::kLostBefore} : 0U);
      std::get<std::vector<double>>(block.rows.channels[0])
          .push_back(level + (k % 2 == 0 ? 1e-3 : -1e-3));
    }
    watch.take(block);
  };
  take(0.0, false);
  take(1.0, true);
  EXPECT_TRUE(watch.disturbances().empty());
  take(2.0, false);
  EXPECT_EQ(watch.disturbances().size(), 1U);
}

TEST(Stillness, WhatSeveralDevicesSawAtOnceIsOne) {
  const auto made = [](const char* device, std::int64_t begin, std::int64_t end, double size) {
    v1::Disturbance out;
    out.set_device(device);
    out.set_channel(std::string("gyro_of_") + device);
    out.set_begin_ns(begin);
    out.set_end_ns(end);
    out.set_size(size);
    return out;
  };
  const auto merged = merge_disturbances(
      {made("b", 20, 40, 50.0), made("a", 10, 30, 20.0), made("a", 50, 60, 12.0)});
  ASSERT_EQ(merged.size(), 2U);
  EXPECT_EQ(merged[0].device(), "a");
  EXPECT_EQ(merged[0].channel(), "gyro_of_b");
  EXPECT_EQ(merged[0].begin_ns(), 10);
  EXPECT_EQ(merged[0].end_ns(), 40);
  EXPECT_EQ(merged[0].size(), 50.0);
}

}  // namespace
}  // namespace imunoise::acquire
