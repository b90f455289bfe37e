// Any bytes as an Xbus stream: no crash, finite values only, and the same samples whatever the
// pieces. The rest of the input after a first byte below 128 is also tried as MTData2 and as legacy
// MTData within correct frames, behind a Configuration that the input chooses.

#include <algorithm>

#include "drivers/xsens/codec/decoder.h"
#include "drivers/xsens/codec/messages.h"
#include "tests/fuzz/decoders.h"

using namespace imunoise::drivers;

namespace {

void append(std::vector<std::uint8_t>& out, XsensMessage message, Bytes payload) {
  const auto frame = encode_message(message, payload);
  out.insert(out.end(), frame.begin(), frame.end());
}

// Payloads end where a byte 0xee stands.
std::vector<std::uint8_t> framed(Bytes bytes) {
  BigEndianReader in(bytes);
  std::vector<std::uint8_t> out;
  const auto mode = in.take<std::uint16_t>();
  const LegacyLayout layout{mode, in.take<std::uint32_t>()};
  append(out, XsensMessage::kConfiguration, encode_configuration({1, 1152, 0, layout}));
  for (Bytes rest = in.take_bytes(in.left()); !rest.empty();) {
    const auto end = std::find(rest.begin(), rest.end(), 0xee);
    const auto length = static_cast<std::size_t>(end - rest.begin());
    const Bytes payload = rest.first(std::min(length, kXbusMaximumPayload));
    append(out, XsensMessage::kMtData2, payload);
    append(out, XsensMessage::kMtData, payload);
    rest = rest.subspan(std::min(length + 1, rest.size()));
  }
  return out;
}

}  // namespace

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  if (size < 1) return 0;
  const Bytes rest(data + 1, size - 1);
  const std::vector<std::uint8_t> bytes =
      data[0] < 128 ? framed(rest) : std::vector<std::uint8_t>(rest.begin(), rest.end());
  require_same_samples([] { return XbusDecoder(); }, bytes, data[0] % 16U + 1U);
  return 0;
}
