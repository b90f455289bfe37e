#pragma once

#include <cstddef>
#include <cstdint>
#include <optional>
#include <utility>
#include <vector>

namespace imunoise::emulator {

/// What goes wrong, and when: samples are counted from 0.
struct Fault {
  enum class Kind : std::uint8_t {
    kBitError,  ///< A bit of the sample's message is flipped (CAN: an error frame, and again).
    kLoss,      ///< Bytes of the sample's message are lost (CAN: whole frames).
    kStall,     ///< The device sends nothing, and counts on.
    kLate,      ///< Samples are held back, and then come all at once.
    kUnplug,    ///< The device is unplugged (CAN: the controller is bus-off), then is back.
  };
  Kind kind = Kind::kStall;
  std::uint64_t sample = 0;  ///< The first concerned.
  std::uint64_t count = 1;   ///< Samples, or bytes (kLoss on a line).
  std::size_t at = 0;        ///< Bit (kBitError) or byte (kLoss) of the message.
};

/// Which fault a sample meets; the first of them that concerns it.
class FaultPlan {
 public:
  explicit FaultPlan(std::vector<Fault> faults) : faults_(std::move(faults)) {}

  std::optional<Fault> at(std::uint64_t sample) const {
    for (const Fault& fault : faults_) {
      const bool lasts = fault.kind == Fault::Kind::kStall || fault.kind == Fault::Kind::kLate;
      const std::uint64_t samples = lasts ? fault.count : 1;
      if (sample >= fault.sample && sample - fault.sample < samples) return fault;
    }
    return std::nullopt;
  }

 private:
  std::vector<Fault> faults_;
};

}  // namespace imunoise::emulator
