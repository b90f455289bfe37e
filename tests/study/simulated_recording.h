#pragma once

// Small recordings of simulated noise, made by the recorder itself.

#include <unistd.h>

#include <cstdint>
#include <filesystem>
#include <string>
#include <vector>

namespace imunoise::testing {

inline constexpr std::int64_t kSimulatedStart = 1'700'000'000'000'000'000;  // ns since 1970

/// A folder of its own, removed at the end.
class TemporaryFolder {
 public:
  TemporaryFolder() {
    std::string pattern = (std::filesystem::temp_directory_path() / "imunoise-XXXXXX").string();
    path_ = ::mkdtemp(pattern.data());
  }
  ~TemporaryFolder() { std::filesystem::remove_all(path_); }
  TemporaryFolder(const TemporaryFolder&) = delete;
  TemporaryFolder& operator=(const TemporaryFolder&) = delete;
  const std::filesystem::path& path() const { return path_; }

 private:
  std::filesystem::path path_;
};

struct SimulatedChannel {
  std::string name;
  std::string unit;
  std::string model;  ///< with all its values; empty: the channel never changes
};

struct SimulatedRecording {
  std::filesystem::path folder;
  std::string device = "imu0";
  std::string serial = "0042";
  std::vector<SimulatedChannel> channels;
  std::size_t samples = 4096;  ///< of each replicate, at 100 Hz
  std::uint32_t first_replicate = 1;
  std::uint32_t replicates = 3;
  std::int64_t started_ns = kSimulatedStart;
  std::uint64_t seed = 1;
};

/// Records it: one stream "imu" of doubles. A failure is one of the running test.
void record(const SimulatedRecording& what);

}  // namespace imunoise::testing
