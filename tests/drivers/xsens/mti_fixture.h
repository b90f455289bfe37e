#pragma once

// An emulated MTi on a pseudo-terminal, and the driver that records it.

#include <gtest/gtest.h>
#include <unistd.h>

#include <filesystem>
#include <memory>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "drivers/emulator/sensors/xsens_on_pty.h"
#include "tests/drivers/lively_source.h"
#include "tests/drivers/recording_session.h"

namespace imunoise::testing {

class MtiTest : public ::testing::Test {
 protected:
  MtiTest()
      : folder_(std::filesystem::temp_directory_path() /
                ("imunoise_mti_" + std::to_string(getpid()))) {
    std::filesystem::create_directories(folder_);
  }
  ~MtiTest() override { std::filesystem::remove_all(folder_); }

  std::filesystem::path link() const { return folder_ / "mti"; }
  /// libserialport takes only names that begin with /dev/, and looks them up in /sys/class/tty.
  std::string port() const { return "/dev/../../.." + link().string(); }

  void plug_in(emulator::MtiOptions options = {}, std::vector<emulator::Fault> faults = {},
               std::unique_ptr<emulator::SampleSource> source = std::make_unique<LivelySource>()) {
    source_ = std::move(source);
    mti_.emplace(std::move(options), *source_, std::move(faults), link());
  }
  Result<std::unique_ptr<RecordingSession>> open(
      std::vector<drivers::OptionText> options = {}) const {
    options.push_back({"port", port()});
    return RecordingSession::open(IMUNOISE_DRIVER_FOLDER, "xsens", options);
  }

  /// What was sent whole, as far as there are rows.
  std::vector<emulator::MtiMessage> intact(std::size_t count) const {
    std::vector<emulator::MtiMessage> out;
    for (const emulator::SentMessage& sent : mti_->sent()) {
      if (sent.intact && out.size() < count) out.push_back(sent.message);
    }
    return out;
  }

  std::filesystem::path folder_;
  std::unique_ptr<emulator::SampleSource> source_;
  std::optional<emulator::XsensOnPty> mti_;
};

}  // namespace imunoise::testing
