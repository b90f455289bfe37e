// Any bytes as ADIS16405 bursts: finite values only, and the same samples whatever the pieces; what
// is accepted comes back from the encoder.

#include <algorithm>

#include "drivers/adis16405/bridges/mpsse.h"
#include "drivers/adis16405/codec/decoder.h"
#include "drivers/adis16405/codec/registers.h"
#include "tests/fuzz/decoders.h"

using namespace imunoise::drivers;
using namespace imunoise::drivers::adis16405;

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  BigEndianReader in(Bytes(data, size));
  const auto sensitivity = in.take<std::uint16_t>();
  const auto period = in.take<std::uint16_t>();
  const Bytes bytes = in.take_bytes(in.left());
  std::vector<std::uint8_t> stripped;
  strip_ftdi_status(bytes, stripped);
  if (stripped.size() > bytes.size()) std::abort();
  if (bytes.size() >= kBurstBytes) {
    const auto burst = decode_burst(bytes.first(kBurstBytes));
    if (burst && *decode_burst(encode_burst(*burst)) != *burst) std::abort();
  }
  diagnosis(sensitivity);
  const auto scales = count_scales(sensitivity);
  if (!scales) return 0;
  require_same_samples([&] { return BurstDecoder(*scales, sample_rate(period)); }, bytes,
                       period % 64U + 1U);
  return 0;
}
