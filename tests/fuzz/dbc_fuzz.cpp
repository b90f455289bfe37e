// Any text as a DBC file: no crash, and every message that was accepted can be decoded from any
// data and encoded again to the same bits.

#include <cmath>
#include <cstdlib>

#include "drivers/can/codec/channels.h"
#include "drivers/can/codec/dbc.h"

using namespace imunoise::drivers;

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  const std::string_view text(static_cast<const char*>(static_cast<const void*>(data)), size);
  const auto database = parse_dbc(text, "fuzz.dbc");
  if (!database) {
    if (database.error().message.find("fuzz.dbc:") != 0) std::abort();
    return 0;
  }
  const Bytes bytes = Bytes(data, size).first(std::min<std::size_t>(size, 64));
  for (const CanMessage& message : database->messages()) {
    std::vector<SignalValue> values;
    Refusals refused;
    decode_signals(message, bytes, values, refused);
    for (const SignalValue& value : values) {
      const CanSignal& signal = *value.signal;
      std::vector<std::uint8_t> copy(bytes.begin(), bytes.end());
      insert_bits(copy, signal.field, value.bits);
      if (!std::equal(bytes.begin(), bytes.end(), copy.begin())) std::abort();
      const auto again = bits_for(signal, value.physical);
      if (!again && again.error().message.empty()) std::abort();
    }
  }
  const auto channels = CanChannels::make(*database, {});
  if (!channels) std::abort();
  return 0;
}
