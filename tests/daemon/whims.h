#pragma once

// Devices of the driver "whims", each with its file, and a folder for what is recorded.

#include <gtest/gtest.h>
#include <unistd.h>

#include <filesystem>
#include <fstream>
#include <string>

#include "drivers/host/load.h"

namespace imunoise::testing {

class Whims : public ::testing::Test {
 protected:
  Whims()
      : folder_(std::filesystem::temp_directory_path() /
                ("imunoise_whims_" + std::to_string(getpid()))) {
    std::filesystem::remove_all(folder_);
    std::filesystem::create_directories(folder_);
  }
  ~Whims() override { std::filesystem::remove_all(folder_); }

  /// Whole words only: a reader sees the old one or the new one.
  void tell(const std::string& device, const std::string& word) const {
    std::ofstream(folder_ / "part") << word;
    std::filesystem::rename(folder_ / "part", word_of(device));
  }
  std::filesystem::path word_of(const std::string& device) const {
    return folder_ / (device + ".word");
  }

  static const drivers::Drivers& drivers() {
    static const drivers::Drivers kFound = drivers::load_drivers({IMUNOISE_TEST_PLUGINS});
    return kFound;
  }

  std::filesystem::path folder_;
};

}  // namespace imunoise::testing
