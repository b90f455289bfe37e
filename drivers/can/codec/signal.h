#pragma once

// Numbers inside the data of CAN messages, as DBC files describe them.

#include <cstddef>
#include <cstdint>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "core/support/result.h"
#include "drivers/codec/bytes.h"

namespace imunoise::drivers {

enum class ByteOrder : std::uint8_t {
  kBig,     ///< Motorola (@0): the start is the most significant bit
  kLittle,  ///< Intel (@1): the start is the least significant bit
};

enum class SignalType : std::uint8_t { kUnsigned, kSigned, kFloat32, kFloat64 };

/// Where a number lies. Bit 8·i + k of the data is bit k (0 the least significant) of byte i.
struct BitField {
  std::size_t start = 0;
  std::size_t length = 1;  ///< 1 to 64
  ByteOrder order = ByteOrder::kLittle;
};

/// Bytes of data that the field needs.
std::size_t bytes_needed(const BitField& field);
/// The field's bits. Precondition: bytes_needed(field) <= data.size().
std::uint64_t extract_bits(Bytes data, const BitField& field);
/// Overwrites the field's bits with the lowest ones of `value`. Precondition: as extract_bits().
void insert_bits(std::span<std::uint8_t> data, const BitField& field, std::uint64_t value);

/// Values of a multiplexor at which a signal is present, both ends included.
struct MultiplexRange {
  std::uint64_t first = 0;
  std::uint64_t last = 0;
};

struct CanSignal {
  std::string name;
  BitField field;
  SignalType type = SignalType::kUnsigned;
  double factor = 1.0;  ///< physical = number · factor + offset; not zero
  double offset = 0.0;
  std::string unit;
  bool multiplexor = false;  ///< Its value says which others are present.
  /// Index, in its message, of the signal that switches this one; nothing: always present.
  std::optional<std::size_t> switched_by;
  std::vector<MultiplexRange> present_at;
};

/// The bits of a field of that length as a signed number.
constexpr std::int64_t sign_extended(std::uint64_t bits, std::size_t length) {
  const std::size_t unused = 64 - length;
  return static_cast<std::int64_t>(bits << unused) >> static_cast<int>(unused);
}

/// The physical value of the field's bits.
double physical_value(const CanSignal& signal, std::uint64_t bits);
/// The bits that come nearest to a physical value. Error: the signal cannot hold it.
Result<std::uint64_t> bits_for(const CanSignal& signal, double physical);

}  // namespace imunoise::drivers
