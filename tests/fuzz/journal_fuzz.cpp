// Any bytes as a journal segment: no crash, and what is accepted adds up. The input is also put
// into frames with right checksums, else nothing would ever get past them.

#include <algorithm>
#include <cstdint>
#include <cstdlib>
#include <string>

#include "recording/store/format/format_version.h"
#include "recording/store/journal/journal_reader.h"

using namespace imunoise;
using namespace imunoise::recording;

namespace {

v1::JournalHeader neighbour() {
  v1::JournalHeader out;
  out.set_version(kFormatVersion);
  out.set_replicate(1);
  v1::RecordedDevice& device = *out.mutable_device();
  device.set_name("imu0");
  v1::RecordedStream& stream = *device.add_streams();
  stream.set_name("imu");
  stream.set_rate_hz(100.0);
  stream.set_counter_modulus(256);
  v1::RecordedChannel& channel = *stream.add_channels();
  channel.set_name("x");
  channel.set_dtype("<i2");
  return out;
}

// A byte of the input is a length, what follows the payload of a frame, and so on.
std::string framed(std::string_view bytes) {
  std::string out;
  std::uint64_t sequence = 0;
  while (!bytes.empty()) {
    const std::size_t length = static_cast<unsigned char>(bytes.front());
    bytes.remove_prefix(1);
    out += frame(sequence++, bytes.substr(0, length));
    bytes.remove_prefix(std::min(length, bytes.size()));
  }
  return out;
}

void check(std::string_view bytes, const v1::JournalHeader* fallback) {
  const auto got = read_segment(bytes, 0, fallback);
  if (!got || !got->chunk) return;
  const Chunk& chunk = *got->chunk;
  if (!check_device(chunk.device) || chunk.first_sequence > chunk.last_sequence) std::abort();
  for (std::size_t i = 0; i < chunk.streams.size(); ++i) {
    if (!check_block(chunk.device, {i, chunk.streams[i]})) std::abort();
  }
}

}  // namespace

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  const std::string_view bytes(static_cast<const char*>(static_cast<const void*>(data)), size);
  static const v1::JournalHeader header = neighbour();
  check(bytes, nullptr);
  check(framed(bytes), nullptr);
  check(header_frame(header) + framed(bytes), &header);
  return 0;
}
