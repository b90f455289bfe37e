#pragma once

// Recordings of several simulated devices, each with a clock of its own, made by the recorder
// itself.

#include <cstdint>
#include <filesystem>
#include <functional>
#include <string>
#include <vector>

namespace imunoise::testing {

struct BenchChannel {
  std::string name;
  std::string unit;
  /// Sample i, taken `seconds` after the replicate began, by the host's clock.
  std::function<double(std::size_t i, double seconds)> value;
};

struct BenchDevice {
  std::string name = "imu0";
  std::string serial = "0042";
  double rate_hz = 100.0;  ///< nominal
  double ppm = 0.0;        ///< 1e-6: how much faster its clock runs
  double after_s = 0.0;    ///< when its first sample is taken
  std::size_t samples = 0;
  double late_s = 0.0;  ///< mean of the chance delay on the way to the host
  std::vector<BenchChannel> channels;
};

/// One replicate, of doubles in one stream "imu" a device. A failure is one of the running test.
void record_bench(const std::filesystem::path& folder, std::uint32_t replicate,
                  std::int64_t started_ns, const std::vector<BenchDevice>& devices);

}  // namespace imunoise::testing
