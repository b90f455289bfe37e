#pragma once

#include <algorithm>
#include <cstddef>

#include "drivers/codec/stream_decoder.h"

namespace imunoise::drivers::testing {

/// Gives `bytes` to a decoder in pieces of `piece` bytes, and every sample to `take`.
template <class Take>
void decode_in_pieces(StreamDecoder& decoder, Bytes bytes, std::size_t piece, Take take) {
  DecodedSample sample;
  const auto drain = [&] {
    while (decoder.next(sample)) take(sample);
  };
  while (!bytes.empty()) {
    const Bytes now = bytes.first(std::min(piece, bytes.size()));
    bytes = bytes.subspan(now.size());
    decoder.push(now);
    drain();
  }
  decoder.finish();
  drain();
}

}  // namespace imunoise::drivers::testing
