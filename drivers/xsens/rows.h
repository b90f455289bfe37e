#pragma once

// From the messages of a configured device to rows of its streams.

#include <cstdint>
#include <memory>
#include <optional>
#include <vector>

#include "drivers/plugin/samples.h"
#include "drivers/xsens/codec/frame.h"
#include "drivers/xsens/setup.h"

namespace imunoise::xsens {

/// Numbers stay as the device sends them: float32, float64, or fixed point as integers with a
/// scale.
class RowMaker {
 public:
  static std::unique_ptr<RowMaker> make(const Setup& setup);
  virtual ~RowMaker() = default;
  RowMaker(const RowMaker&) = delete;
  RowMaker& operator=(const RowMaker&) = delete;

  /// Streams of the device; the first has the counter.
  const std::vector<drivers::Stream>& streams() const { return streams_; }
  /// Adds what a message of measured data holds, or counts why it does not.
  virtual void add(const drivers::XbusFrame& frame, std::int64_t host_time_ns,
                   plugin::Samples& samples) = 0;
  /// The device started anew, and so do counter and time.
  virtual void restart();

 protected:
  RowMaker() = default;
  // Flags of the next row of this stream.
  std::uint32_t flags_of(std::size_t stream, std::optional<std::uint16_t> counter,
                         std::optional<std::uint32_t> status);

  std::vector<drivers::Stream> streams_;

 private:
  std::optional<std::uint16_t> last_counter_;
  std::vector<bool> restarted_;  // by stream: its next row is the first since a restart
};

}  // namespace imunoise::xsens
