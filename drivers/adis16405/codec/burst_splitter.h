#pragma once

#include <cstddef>
#include <cstdint>
#include <optional>
#include <vector>

#include "drivers/adis16405/codec/burst.h"
#include "drivers/codec/bytes.h"
#include "drivers/codec/refusal.h"

namespace imunoise::drivers::adis16405 {

/// Bytes of bursts one after another, cut into bursts, whatever the pieces in which they arrive.
/// Bursts carry no mark to find them by: if bytes were dropped, all that follows is wrong.
class BurstSplitter {
 public:
  void push(Bytes bytes);
  /// There are no more bytes: what is left is no whole burst.
  void finish() { finished_ = true; }
  /// The next 26 bytes, borrowed until the next push(); nothing when more bytes are needed.
  std::optional<Bytes> next();

  /// A burst that the end cuts off.
  const Refusals& refused() const { return refused_; }

 private:
  std::vector<std::uint8_t> buffer_;
  std::size_t begin_ = 0;  // bytes before it are done with
  bool finished_ = false;
  Refusals refused_;
};

}  // namespace imunoise::drivers::adis16405
