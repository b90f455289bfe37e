#pragma once

// The driver as it is shipped, read by the host, beside the sensor that it reads.

#include <gtest/gtest.h>

#include <chrono>
#include <cstddef>
#include <memory>
#include <vector>

#include "drivers/host/load.h"
#include "tests/drivers/adis16405/rig.h"

namespace imunoise::testing {

inline Result<std::unique_ptr<drivers::Device>> open_plugin(
    const std::vector<drivers::OptionText>& options) {
  static const drivers::Drivers kDrivers = drivers::load_drivers({IMUNOISE_DRIVER_FOLDER});
  const auto driver = kDrivers.find("adis16405");
  if (!driver) return tl::make_unexpected(driver.error());
  return drivers::Device::open(**driver, options);
}

/// Reads until there are so many samples of stream "imu", or something else comes.
inline drivers::ReadOutcome read_imu(drivers::Device& device, std::size_t samples,
                                     std::array<Received, 3>& received) {
  using namespace std::chrono_literals;
  drivers::SampleBlock block = device.make_block(512);
  while (received[kImu].rows.size() < samples) {
    const auto outcome = device.read(20s, block);
    EXPECT_TRUE(outcome) << outcome.error().message;
    if (!outcome || *outcome != drivers::ReadOutcome::kSamples) {
      return outcome.value_or(drivers::ReadOutcome::kEnd);
    }
    append(block, received);
  }
  return drivers::ReadOutcome::kSamples;
}

/// Counts of stream "imu" of what a sensor took.
inline std::vector<Counts> imu_counts(const emulator::Adis16405& sensor) {
  std::vector<Counts> out;
  for (const emulator::TakenSample& sample : sensor.taken()) {
    Counts& row = out.emplace_back();
    for (const std::size_t position : kPositions[kImu]) row.push_back(sample.counts[position]);
  }
  return out;
}

}  // namespace imunoise::testing
