#include "drivers/adis16405/settings.h"

#include <fmt/format.h>

#include <cmath>

namespace imunoise::drivers::adis16405 {

Result<std::uint16_t> sensitivity_averaging(double range, unsigned filter) {
  for (const unsigned code : {4U, 2U, 1U}) {
    const auto wanted = static_cast<std::uint16_t>(code << 8U | filter);
    const Result<double> got = gyro_range(wanted);
    if (got ? *got == range : range == 75.0 * code) {
      return got ? Result<std::uint16_t>(wanted) : tl::make_unexpected(got.error());
    }
  }
  return fail(fmt::format("ADIS16405: no range of {:g} °/s; use 300, 150 or 75", range));
}

Result<std::uint16_t> sample_period(Hertz rate) {
  constexpr double kTolerance = 0.01;
  Hertz above{INFINITY};
  Hertz below{0.0};
  // Codes from fast to slow: 0x01 to 0x7f, then the slow clock's 0x80 to 0xff.
  for (std::uint16_t code = kDefaultSamplePeriod; code <= 0xff; ++code) {
    const Hertz has = sample_rate(code);
    if (std::abs(has.value / rate.value - 1.0) <= kTolerance) return code;
    if (has.value > rate.value && has.value < above.value) above = has;
    if (has.value < rate.value && has.value > below.value) below = has;
  }
  return fail(
      fmt::format("ADIS16405: cannot sample at {:g} Hz; the nearest it can: {:.6g} and "
                  "{:.6g} Hz",
                  rate.value, std::isinf(above.value) ? below.value : above.value,
                  below.value > 0.0 ? below.value : above.value));
}

}  // namespace imunoise::drivers::adis16405
