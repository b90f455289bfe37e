#pragma once

#include <gtest/gtest.h>
#include <unistd.h>

#include <filesystem>
#include <fstream>
#include <memory>
#include <string>
#include <string_view>
#include <vector>

#include "tests/drivers/recording_session.h"

namespace imunoise::testing {

/// A file with captured bytes, and the driver that replays it.
class Capture : public ::testing::Test {
 protected:
  using Options = std::vector<drivers::OptionText>;

  ~Capture() override { std::filesystem::remove(path_); }

  void write(std::string_view bytes) const {
    std::ofstream(path_, std::ios::binary)
        .write(bytes.data(), static_cast<std::streamsize>(bytes.size()));
  }
  auto open(Options options, const std::string& format) const {
    options.push_back({"file", path_.string()});
    options.push_back({"format", format});
    return RecordingSession::open(IMUNOISE_DRIVER_FOLDER, "wire", options);
  }
  /// Opens it for a replay at once; fails the test where it cannot.
  std::unique_ptr<RecordingSession> replay(Options options, const std::string& format) const {
    options.push_back({"speed", "0"});
    auto out = open(std::move(options), format);
    EXPECT_TRUE(out) << out.error().message;
    return out ? std::move(*out) : nullptr;
  }
  void expect_refused(const Options& options, const std::string& format,
                      const std::string& words) const {
    const auto session = open(options, format);
    ASSERT_FALSE(session) << words;
    EXPECT_NE(session.error().message.find(words), std::string::npos) << session.error().message;
  }

  std::filesystem::path path_ =
      std::filesystem::temp_directory_path() / ("imunoise_wire_" + std::to_string(getpid()));
};

}  // namespace imunoise::testing
