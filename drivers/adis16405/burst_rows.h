#pragma once

// From bursts to samples.

#include <cstddef>
#include <cstdint>
#include <vector>

#include "drivers/adis16405/gatherer.h"
#include "drivers/adis16405/settings.h"
#include "drivers/plugin.h"

namespace imunoise::drivers::adis16405 {

/// What the sensor delivers: "imu" (gyroscopes, accelerometers), "magnetometer", "housekeeping"
/// (supply, temperature, auxiliary input), each by the counts of the device. They come in the same
/// burst, but nothing says that all are renewed as often. Precondition: settings of settings.h.
std::vector<Stream> describe_streams(const Settings& settings);

/// Adds bursts to streams numbered as in describe_streams(). Refused, for each stream: bursts in
/// which nothing is new (stale), samples of which some words never came, and bursts that nothing
/// drove (malformed). What follows a refusal is marked IMUNOISE_SAMPLE_AFTER_GAP; the first sample
/// IMUNOISE_SAMPLE_AFTER_RESTART. One thread at a time.
class BurstRows {
 public:
  /// `poll`: most bursts are stale, and mean no gap.
  explicit BurstRows(bool poll);

  struct Taken {
    bool inertial = false;  ///< Stream "imu" has a sample more.
    bool alarm = false;     ///< DIAG_STAT should be read.
  };
  Taken take(Bytes bytes, std::int64_t host_time_ns, plugin::Samples& samples);
  /// Counts a burst that is not looked at.
  void refuse(plugin::Reason reason, plugin::Samples& samples);
  /// Samples were lost before the next one.
  void mark_gap();

 private:
  struct State {  // of a stream
    Gatherer gatherer;
    std::uint32_t next_flags;
  };
  void add(std::size_t stream, std::int64_t host_time_ns, plugin::Samples& samples);
  void refuse(std::size_t stream, plugin::Reason reason, std::size_t count,
              plugin::Samples& samples);

  bool poll_;
  std::vector<State> streams_;
};

}  // namespace imunoise::drivers::adis16405
