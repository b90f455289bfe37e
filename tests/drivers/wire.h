#pragma once

// Bytes as people write them, and decoders fed in pieces.

#include <algorithm>
#include <cstdint>
#include <limits>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "drivers/codec/stream_decoder.h"
#include "tests/drivers/pieces.h"

namespace imunoise::drivers::testing {

/// "fa ff 3000" → {0xfa, 0xff, 0x30, 0x00}.
inline std::vector<std::uint8_t> from_hex(std::string_view text) {
  std::vector<std::uint8_t> out;
  std::string digits;
  for (const char c : text) {
    if (c != ' ') digits += c;
    if (digits.size() < 2) continue;
    out.push_back(static_cast<std::uint8_t>(std::stoul(digits, nullptr, 16)));
    digits.clear();
  }
  return out;
}

/// A sample that owns its texts and can be compared.
struct OwnedValue {
  std::string channel;
  std::string unit;
  double value = 0.0;
  friend bool operator==(const OwnedValue&, const OwnedValue&) = default;
};

struct OwnedSample {
  std::string stream;
  std::string source;
  Clock clock = Clock::kNone;
  std::int64_t time_ns = 0;
  std::optional<std::int64_t> counter;
  std::vector<OwnedValue> values;
  std::vector<std::string> flags;
  friend bool operator==(const OwnedSample&, const OwnedSample&) = default;

  /// The channel's value; NaN if the sample has no such channel.
  double at(std::string_view channel) const {
    for (const OwnedValue& value : values) {
      if (value.channel == channel) return value.value;
    }
    return std::numeric_limits<double>::quiet_NaN();
  }
  bool has_flag(std::string_view flag) const {
    return std::find(flags.begin(), flags.end(), flag) != flags.end();
  }
};

inline OwnedSample own(const DecodedSample& sample) {
  OwnedSample out{std::string(sample.stream),
                  std::string(sample.source),
                  sample.clock,
                  sample.time_ns,
                  sample.counter,
                  {},
                  {}};
  for (const DecodedValue& value : sample.values) {
    out.values.push_back({std::string(value.channel), std::string(value.unit), value.value});
  }
  for (const std::string_view flag : sample.flags) out.flags.emplace_back(flag);
  return out;
}

/// Everything that `decoder` makes of `bytes`, handed over in pieces of `piece` bytes.
inline std::vector<OwnedSample> decode_all(StreamDecoder& decoder, Bytes bytes,
                                           std::size_t piece = ~std::size_t{0}) {
  std::vector<OwnedSample> out;
  decode_in_pieces(decoder, bytes, piece,
                   [&](const DecodedSample& sample) { out.push_back(own(sample)); });
  return out;
}

}  // namespace imunoise::drivers::testing
