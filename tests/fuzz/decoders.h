#pragma once

// What holds for every decoder of a stream.

#include <cmath>
#include <cstdint>
#include <cstdlib>
#include <string>
#include <vector>

#include "drivers/codec/stream_decoder.h"
#include "tests/drivers/pieces.h"

namespace imunoise::drivers {

/// Everything that a decoder says of `bytes` in pieces of `piece` bytes, as text; values are
/// finite.
inline std::string transcript(StreamDecoder& decoder, Bytes bytes, std::size_t piece) {
  std::string out;
  testing::decode_in_pieces(decoder, bytes, piece, [&](const DecodedSample& sample) {
    out += sample.stream;
    out += sample.source;
    out += std::to_string(sample.time_ns) + ' ' + std::to_string(sample.counter.value_or(-1));
    for (const DecodedValue& value : sample.values) {
      if (!std::isfinite(value.value)) std::abort();
      out += value.channel;
      out += value.unit;
      out += std::to_string(value.value);
    }
    for (const std::string_view flag : sample.flags) out += flag;
  });
  for (std::size_t i = 0; i < kRefusals; ++i) {
    out += ' ' + std::to_string(decoder.tally().refused.count(static_cast<Refusal>(i)));
  }
  return out;
}

/// Ends the program if the pieces in which bytes arrive change what `make()`'s decoder says.
template <class Make>
void require_same_samples(Make make, Bytes bytes, std::size_t piece) {
  auto whole = make();
  auto pieces = make();
  if (transcript(whole, bytes, bytes.size() + 1) != transcript(pieces, bytes, piece)) std::abort();
}

}  // namespace imunoise::drivers
