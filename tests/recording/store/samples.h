#pragma once

// A device whose every sample can be told from every other, for the tests of the store.

#include <gtest/gtest.h>

#include <cstdint>
#include <string>
#include <vector>

#include "recording/store/reading/device_recording.h"
#include "recording/store/stream/stream.h"

namespace imunoise::recording {

inline v1::RecordedChannel channel(const std::string& name, const std::string& dtype) {
  v1::RecordedChannel out;
  out.set_name(name);
  out.set_dtype(dtype);
  return out;
}

/// Stream "imu": counts with a counter; stream "slow": a float without one.
inline v1::RecordedDevice test_device(const std::string& name = "imu0") {
  v1::RecordedDevice out;
  out.set_name(name);
  out.set_driver("adis16405");
  out.set_serial("0042");
  (*out.mutable_metadata())["product"] = "16405";
  v1::RecordedStream* const imu = out.add_streams();
  imu->set_name("imu");
  imu->set_rate_hz(100.0);
  imu->set_counter_modulus(65536);
  v1::RecordedChannel* const gyro = imu->add_channels();
  *gyro = channel("gyro_x", "<i2");
  gyro->set_units("deg/s");
  gyro->set_scale_factor(0.05);
  gyro->set_long_name("angular rate about x");
  *imu->add_channels() = channel("row", "<i4");
  v1::RecordedStream* const slow = out.add_streams();
  slow->set_name("slow");
  slow->set_rate_hz(1.0);
  *slow->add_channels() = channel("temperature", "<f4");
  return out;
}

constexpr std::int64_t kStart = 1'700'000'000'000'000'000;  // ns

/// Rows `first`, `first` + 1, ... of stream "imu": channel "row" holds their index.
inline Block imu_block(int first, int count) {
  Block out{0, empty_rows(test_device().streams(0))};
  for (int i = first; i < first + count; ++i) {
    out.rows.host_time.push_back(kStart + std::int64_t{i} * 10'000'000);
    out.rows.counter.push_back(i % 65536);
    out.rows.flags.push_back(0);
    std::get<std::vector<std::int16_t>>(out.rows.channels[0])
        .push_back(static_cast<std::int16_t>(i * 7 % 2001 - 1000));
    std::get<std::vector<std::int32_t>>(out.rows.channels[1]).push_back(i);
  }
  out.rows.received = out.rows.size();
  return out;
}

/// One row of stream "slow".
inline Block slow_block(int index) {
  Block out{1, empty_rows(test_device().streams(1))};
  out.rows.host_time = {kStart + std::int64_t{index} * 1'000'000'000};
  out.rows.flags = {0};
  std::get<std::vector<float>>(out.rows.channels[0]) = {static_cast<float>(index)};
  out.rows.received = 1;
  return out;
}

/// Indices of the rows of stream "imu", as they were read back.
inline std::vector<std::int32_t> row_indices(const Rows& imu) {
  return std::get<std::vector<std::int32_t>>(imu.channels[1]);
}

/// Every row from 0 to at least `at_least`, each once and in order.
inline ::testing::AssertionResult holds_rows(const std::vector<std::int32_t>& rows,
                                             std::size_t at_least) {
  for (std::size_t i = 0; i < rows.size(); ++i) {
    if (rows[i] != static_cast<std::int32_t>(i)) {
      return ::testing::AssertionFailure() << "row " << rows[i] << " at place " << i;
    }
  }
  if (rows.size() >= at_least) return ::testing::AssertionSuccess();
  return ::testing::AssertionFailure() << rows.size() << " rows of " << at_least << " acknowledged";
}

}  // namespace imunoise::recording
