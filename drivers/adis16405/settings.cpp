#include "drivers/adis16405/settings.h"

#include <fmt/format.h>

#include <cassert>
#include <cmath>

namespace imunoise::drivers::adis16405 {

Result<std::uint16_t> sensitivity_averaging(unsigned range, unsigned filter) {
  assert(range == 300 || range == 150 || range == 75);
  const auto out = static_cast<std::uint16_t>((range / 75U) << 8U | filter);
  const Result<double> valid = gyro_range(out);
  if (!valid) return tl::make_unexpected(valid.error());
  return out;
}

Result<std::uint16_t> sample_period(Hertz rate) {
  constexpr double kTolerance = 0.01;
  const auto deviation = [&](std::uint16_t code) {
    return std::abs(sample_rate(code).value / rate.value - 1.0);
  };
  // Codes from fast to slow: 0x01 to 0x7f, then the slow clock's 0x80 to 0xff.
  std::uint16_t nearest = kDefaultSamplePeriod;
  for (std::uint16_t code = nearest; code <= 0xff; ++code) {
    if (deviation(code) < deviation(nearest)) nearest = code;
  }
  if (deviation(nearest) <= kTolerance) return nearest;
  return fail(
      fmt::format("ADIS16405: cannot sample at {:g} Hz; the nearest that it can is {:.6g} "
                  "Hz (1638.4 or 52.85 Hz over a whole number)",
                  rate.value, sample_rate(nearest).value));
}

}  // namespace imunoise::drivers::adis16405
