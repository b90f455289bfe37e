// Any bytes as a capture to replay: the first says of which kind. What is refused says why; what is
// delivered has finite numbers in the streams that were described.

#include <cstdint>
#include <cstdlib>
#include <memory>

#include "drivers/can/codec/presets.h"
#include "drivers/codec/wire_format.h"
#include "drivers/replay/wire/codec.h"
#include "tests/fuzz/import/memory_file.h"

using namespace imunoise;
using namespace imunoise::replay;

namespace {

std::unique_ptr<WireCodec> open(std::uint8_t kind, const std::filesystem::path& path) {
  switch (drivers::kWireFormats[kind % drivers::kWireFormats.size()]) {
    case drivers::WireFormat::kXbus:
      return open_xbus(path, std::nullopt);
    case drivers::WireFormat::kCandump:
      return open_candump(path, *drivers::make_preset("mti600"), "mti600", std::nullopt);
    case drivers::WireFormat::kAdis16405:
      break;
  }
  return open_bursts(path, {});
}

void replay_all(WireCodec& codec) {
  const drivers::DeviceInfo info = codec.info();
  if (info.streams.empty()) std::abort();
  plugin::Samples samples(info.streams);
  while (const auto time = codec.next()) codec.take(*time, samples);
}

}  // namespace

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  if (size == 0) return 0;
  const recording::MemoryFile file(
      {static_cast<const char*>(static_cast<const void*>(data + 1)), size - 1});
  try {
    replay_all(*open(data[0], file.path()));
  } catch (const plugin::DeviceError& error) {
    if (std::string_view(error.what()).empty()) std::abort();
  }
  return 0;
}
