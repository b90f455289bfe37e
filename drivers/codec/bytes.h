#pragma once

// Big-endian numbers in and out of bytes, as Xbus and the ADIS16405's SPI send them.

#include <concepts>
#include <cstddef>
#include <cstdint>
#include <span>
#include <type_traits>
#include <vector>

namespace imunoise::drivers {

/// Borrowed bytes as they came over the wire.
using Bytes = std::span<const std::uint8_t>;

/// Takes numbers from the front of some bytes. Past the end it gives zeros and ok() turns false, so
/// that a whole structure is read first and checked once.
class BigEndianReader {
 public:
  explicit BigEndianReader(Bytes bytes) : rest_(bytes) {}

  template <std::integral T>
  T take() {
    using Unsigned = std::make_unsigned_t<T>;
    std::uint64_t out = 0;
    for (const std::uint8_t byte : take_bytes(sizeof(T))) out = out << 8U | byte;
    return static_cast<T>(static_cast<Unsigned>(out));
  }

  /// The next `count` bytes; empty when fewer are left.
  Bytes take_bytes(std::size_t count) {
    if (count > rest_.size()) {
      ok_ = false;
      rest_ = {};
      return {};
    }
    const Bytes out = rest_.first(count);
    rest_ = rest_.subspan(count);
    return out;
  }

  bool ok() const { return ok_; }
  std::size_t left() const { return rest_.size(); }

 private:
  Bytes rest_;
  bool ok_ = true;
};

/// Appends `value` to `out`, most significant byte first.
template <std::integral T>
void append_big_endian(std::vector<std::uint8_t>& out, T value) {
  const auto bits = static_cast<std::uint64_t>(static_cast<std::make_unsigned_t<T>>(value));
  for (std::size_t i = sizeof(T); i-- > 0;) {
    out.push_back(static_cast<std::uint8_t>(bits >> (8U * i)));
  }
}

}  // namespace imunoise::drivers
