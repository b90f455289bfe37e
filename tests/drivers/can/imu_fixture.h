#pragma once

// An emulated CAN IMU, and the driver that records it.

#include <gtest/gtest.h>
#include <unistd.h>

#include <filesystem>
#include <fstream>
#include <memory>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "drivers/can/channel_option.h"
#include "drivers/can/codec/dbc.h"
#include "drivers/can/codec/presets.h"
#include "drivers/emulator/sensors/can_imu.h"
#include "tests/drivers/can/as_sent.h"
#include "tests/drivers/can/fake_can_bus.h"
#include "tests/drivers/lively_source.h"
#include "tests/drivers/recording_session.h"

namespace imunoise::testing {

using Options = std::vector<drivers::OptionText>;

class CanImuTest : public ::testing::Test {
 protected:
  ~CanImuTest() override { std::filesystem::remove(file()); }

  static std::filesystem::path file() {
    return std::filesystem::temp_directory_path() /
           ("imunoise_can_" + std::to_string(getpid()) + ".dbc");
  }
  // Writes a database and returns the options that name it and its channels.
  static Options describe(const std::string& dbc, const std::vector<std::string>& channels) {
    std::ofstream(file()) << dbc;
    Options out = {{"dbc", file().string()}};
    for (const std::string& channel : channels) out.push_back({"channel", channel});
    return out;
  }
  static drivers::CanChannels channels(const std::string& dbc,
                                       const std::vector<std::string>& texts) {
    std::vector<drivers::ChannelMapping> mapping;
    for (const std::string& text : texts) mapping.push_back(*can::parse_channel_option(text));
    return *drivers::CanChannels::make(*drivers::parse_dbc(dbc, "test"), mapping);
  }

  void plug_in(drivers::CanChannels channels, double rate_hz,
               std::vector<emulator::Fault> faults = {}) {
    imu_.emplace(std::move(channels), rate_hz, source_, bus_, std::move(faults));
  }
  static Result<std::unique_ptr<RecordingSession>> open(Options options) {
    options.push_back({"interface", "can7"});
    return RecordingSession::open(IMUNOISE_DRIVER_FOLDER, "can", options);
  }

  LivelySource source_;
  FakeCanBus bus_{"can7"};
  std::optional<emulator::CanImu> imu_;
};

}  // namespace imunoise::testing
