#pragma once

#include <cstdint>

#include "drivers/codec/unwrap.h"

namespace imunoise::drivers {

/// SampleTimeFine of the MTi 10 and 100 series starts again after a day, in ticks of 100 µs.
inline constexpr std::int64_t kXsensDayTicks = 864'000'000;
inline constexpr std::int64_t kXsensTickNs = 100'000;

/// SampleTimeFine as a time that never starts again. It wraps after a day until a larger value
/// shows that it uses all 32 bits.
class XsensSampleClock {
 public:
  /// ns, from the device's own zero.
  std::int64_t operator()(std::uint32_t ticks) {
    if (ticks >= ticks_.modulus()) ticks_.widen(std::int64_t{1} << 32U);
    return ticks_(ticks) * kXsensTickNs;
  }

 private:
  Unwrapper ticks_{kXsensDayTicks};
};

}  // namespace imunoise::drivers
