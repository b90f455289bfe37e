// Any text as lines of candump: the same samples whatever the pieces; a line that was read comes
// back from the formatter with the same frame.

#include "drivers/can/codec/decoder.h"
#include "drivers/can/codec/presets.h"
#include "tests/fuzz/decoders.h"

using namespace imunoise::drivers;

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  static const CanChannels kChannels = *make_preset("mti600");
  const std::string_view text(static_cast<const char*>(static_cast<const void*>(data)), size);
  if (const auto line = parse_candump_line(text.substr(0, text.find('\n')))) {
    const auto again = parse_candump_line(format_candump_line(*line));
    if (!again || again->frame != line->frame) std::abort();
  }
  require_same_samples([] { return CandumpDecoder(kChannels); }, Bytes(data, size), size % 31 + 1);
  return 0;
}
