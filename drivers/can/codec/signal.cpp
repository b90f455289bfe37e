#include "drivers/can/codec/signal.h"

#include <fmt/format.h>

#include <algorithm>
#include <bit>
#include <cassert>
#include <cmath>

namespace imunoise::drivers {
namespace {

// The field as one run of bits from the most significant to the least: bit `position` counts from
// the most significant bit of byte 0 on.
std::size_t sawtooth(std::size_t start) { return start / 8 * 8 + 7 - start % 8; }

// Calls visit(byte, shift, count) for the field's parts, the least significant first: `count` bits
// of that byte from bit `shift` up.
template <class Visit>
void for_each_part(const BitField& field, Visit visit) {
  std::size_t left = field.length;
  if (field.order == ByteOrder::kLittle) {
    for (std::size_t bit = field.start; left > 0;) {
      const std::size_t count = std::min(left, 8 - bit % 8);
      visit(bit / 8, bit % 8, count);
      bit += count;
      left -= count;
    }
    return;
  }
  for (std::size_t end = sawtooth(field.start) + field.length; left > 0;) {
    const std::size_t shift = (8 - end % 8) % 8;
    const std::size_t count = std::min(left, 8 - shift);
    visit((end - 1) / 8, shift, count);
    end -= count;
    left -= count;
  }
}

std::uint64_t low_bits(std::size_t count) {
  return count >= 64 ? ~std::uint64_t{0} : (std::uint64_t{1} << count) - 1;
}

}  // namespace

std::size_t bytes_needed(const BitField& field) {
  const std::size_t first = field.order == ByteOrder::kLittle ? field.start : sawtooth(field.start);
  return (first + field.length + 7) / 8;
}

std::uint64_t extract_bits(Bytes data, const BitField& field) {
  assert(bytes_needed(field) <= data.size());
  std::uint64_t out = 0;
  std::size_t done = 0;
  for_each_part(field, [&](std::size_t byte, std::size_t shift, std::size_t count) {
    out |= (std::uint64_t{data[byte]} >> shift & low_bits(count)) << done;
    done += count;
  });
  return out;
}

void insert_bits(std::span<std::uint8_t> data, const BitField& field, std::uint64_t value) {
  assert(bytes_needed(field) <= data.size());
  for_each_part(field, [&](std::size_t byte, std::size_t shift, std::size_t count) {
    const std::uint64_t mask = low_bits(count) << shift;
    data[byte] = static_cast<std::uint8_t>((data[byte] & ~mask) | (value << shift & mask));
    value >>= count;
  });
}

double physical_value(const CanSignal& signal, std::uint64_t bits) {
  double number = 0.0;
  switch (signal.type) {
    case SignalType::kUnsigned:
      number = static_cast<double>(bits);
      break;
    case SignalType::kSigned:
      number = static_cast<double>(sign_extended(bits, signal.field.length));
      break;
    case SignalType::kFloat32:
      number = static_cast<double>(std::bit_cast<float>(static_cast<std::uint32_t>(bits)));
      break;
    case SignalType::kFloat64:
      number = std::bit_cast<double>(bits);
      break;
  }
  return number * signal.factor + signal.offset;
}

Result<std::uint64_t> bits_for(const CanSignal& signal, double physical) {
  const double number = (physical - signal.offset) / signal.factor;
  if (signal.type == SignalType::kFloat32) {
    return std::uint64_t{std::bit_cast<std::uint32_t>(static_cast<float>(number))};
  }
  if (signal.type == SignalType::kFloat64) return std::bit_cast<std::uint64_t>(number);
  const int bits = static_cast<int>(signal.field.length);
  const bool is_signed = signal.type == SignalType::kSigned;
  const double above = std::ldexp(1.0, is_signed ? bits - 1 : bits);  // first that does not fit
  const double rounded = std::nearbyint(number);
  if (!(rounded >= (is_signed ? -above : 0.0) && rounded < above)) {
    return fail(
        fmt::format("signal {}: {:g} {} does not fit into {} bits with factor {:g} and "
                    "offset {:g}",
                    signal.name, physical, signal.unit, bits, signal.factor, signal.offset));
  }
  const auto whole = is_signed ? static_cast<std::uint64_t>(static_cast<std::int64_t>(rounded))
                               : static_cast<std::uint64_t>(rounded);
  return whole & low_bits(signal.field.length);
}

}  // namespace imunoise::drivers
