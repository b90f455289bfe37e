#pragma once

#include <gtest/gtest.h>

#include <cmath>

#include "drivers/emulator/sensors/can_imu.h"
#include "tests/drivers/recording_session.h"

namespace imunoise::testing {

/// Compares every row of a stream with what the IMU put on the bus: all of it, in order, each value
/// within half a step of what was meant. The first frames went by while the driver listened.
inline void expect_as_sent(const RecordingSession& session, std::size_t stream,
                           const std::vector<emulator::SentCanFrame>& all) {
  const drivers::Stream& description = session.info().streams[stream];
  SCOPED_TRACE(description.name);
  std::vector<emulator::SentCanFrame> sent;
  for (const emulator::SentCanFrame& frame : all) {
    if (frame.sent && frame.message == description.name) sent.push_back(frame);
  }
  const auto& rows = session.rows(stream);
  const auto differs = [&](const ReadRow& row, const emulator::SentCanFrame& frame) {
    for (std::size_t c = 0; c < row.numbers.size(); ++c) {
      const drivers::Channel& channel = description.channels[c];
      const double value = channel.add_offset + channel.scale_factor * row.numbers[c];
      const double step = std::abs(channel.scale_factor) * (0.5 + 1e-9);
      if (channel.name != frame.values[c].first) return true;
      if (std::abs(value - frame.values[c].second) > step) return true;
    }
    return false;
  };
  const auto any_differs_from = [&](std::size_t first) {
    for (std::size_t i = 0; i < rows.size(); ++i) {
      if (differs(rows[i], sent[first + i])) return true;
    }
    return false;
  };
  ASSERT_FALSE(rows.empty());
  std::size_t first = 0;
  while (first + rows.size() <= sent.size() && any_differs_from(first)) ++first;
  ASSERT_LE(first + rows.size(), sent.size()) << "rows that were not sent, or not so";
  for (std::size_t i = 1; i < rows.size(); ++i) {
    ASSERT_GE(rows[i].host_time_ns, rows[i - 1].host_time_ns);
  }
}

}  // namespace imunoise::testing
