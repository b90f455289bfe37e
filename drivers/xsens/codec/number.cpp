#include "drivers/xsens/codec/number.h"

#include <algorithm>
#include <bit>
#include <cmath>

namespace imunoise::drivers {
namespace {

constexpr double kTwo20 = 1048576.0;
constexpr double kTwo32 = 4294967296.0;

// value · one, as an integer of `bits` bits.
std::int64_t fixed_point(double value, double one, unsigned bits) {
  const double limit = std::ldexp(1.0, static_cast<int>(bits) - 1);
  return std::llround(std::clamp(std::nearbyint(value * one), -limit, limit - 1.0));
}

}  // namespace

std::size_t size_of(XsensFormat format) {
  switch (format) {
    case XsensFormat::kFloat32:
    case XsensFormat::kFixed12_20:
      return 4;
    case XsensFormat::kFixed16_32:
      return 6;
    case XsensFormat::kFloat64:
      break;
  }
  return 8;
}

double take_number(BigEndianReader& in, XsensFormat format) {
  switch (format) {
    case XsensFormat::kFloat32:
      return static_cast<double>(std::bit_cast<float>(in.take<std::uint32_t>()));
    case XsensFormat::kFixed12_20:
      return in.take<std::int32_t>() / kTwo20;
    case XsensFormat::kFixed16_32: {
      const double fraction = in.take<std::uint32_t>() / kTwo32;
      return in.take<std::int16_t>() + fraction;
    }
    case XsensFormat::kFloat64:
      break;
  }
  return std::bit_cast<double>(in.take<std::uint64_t>());
}

void append_number(std::vector<std::uint8_t>& out, XsensFormat format, double value) {
  switch (format) {
    case XsensFormat::kFloat32:
      append_big_endian(out, std::bit_cast<std::uint32_t>(static_cast<float>(value)));
      return;
    case XsensFormat::kFixed12_20:
      append_big_endian(out, static_cast<std::int32_t>(fixed_point(value, kTwo20, 32)));
      return;
    case XsensFormat::kFixed16_32: {
      const auto bits = static_cast<std::uint64_t>(fixed_point(value, kTwo32, 48));
      append_big_endian(out, static_cast<std::uint32_t>(bits));
      append_big_endian(out, static_cast<std::uint16_t>(bits >> 32U));
      return;
    }
    case XsensFormat::kFloat64:
      append_big_endian(out, std::bit_cast<std::uint64_t>(value));
      return;
  }
}

}  // namespace imunoise::drivers
