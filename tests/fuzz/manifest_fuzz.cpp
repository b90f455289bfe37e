// Any bytes as a manifest: no crash, what is accepted names only chunks of its own folder, and
// printing and parsing it again changes nothing.

#include <cstdint>
#include <cstdlib>

#include "recording/store/manifest.h"

using namespace imunoise;
using namespace imunoise::recording;

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  const std::string_view json(static_cast<const char*>(static_cast<const void*>(data)), size);
  const auto got = parse_manifest("fuzz.json", json);
  if (!got) return 0;
  for (const v1::ChunkEntry& chunk : got->chunks()) {
    if (chunk.file().find("/../") != std::string::npos || chunk.file().front() == '/') std::abort();
  }
  const std::string printed = print_manifest(*got);
  const auto again = parse_manifest("fuzz.json", printed);
  if (!again || print_manifest(*again) != printed) std::abort();
  return 0;
}
