// Any bytes as the manifest of a recording, and as that of a replicate: no crash, what is accepted
// names only chunks of its own folder, and printing and parsing it again changes nothing.

#include <cstdint>
#include <cstdlib>

#include "recording/store/manifest/manifest.h"

using namespace imunoise;
using namespace imunoise::recording;

namespace {

void check_chunks(const v1::ReplicateManifest& manifest) {
  for (const v1::ChunkEntry& chunk : manifest.chunks()) {
    if (chunk.file().find("/../") != std::string::npos || chunk.file().front() == '/') std::abort();
  }
}

void check_recording(std::string_view json) {
  const auto got = parse_recording_manifest("fuzz.json", json);
  if (!got) return;
  if (got->replicates) {  // version 1
    for (const auto& [replicate, manifest] : *got->replicates) check_chunks(manifest);
    return;
  }
  const std::string printed = print_manifest(got->recording);
  const auto again = parse_recording_manifest("fuzz.json", printed);
  if (!again || print_manifest(again->recording) != printed) std::abort();
}

void check_replicate(std::string_view json) {
  const auto got = parse_replicate_manifest("fuzz.json", json, 1);
  if (!got) return;
  check_chunks(*got);
  const std::string printed = print_manifest(*got);
  const auto again = parse_replicate_manifest("fuzz.json", printed, 1);
  if (!again || print_manifest(*again) != printed) std::abort();
}

}  // namespace

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  const std::string_view json(static_cast<const char*>(static_cast<const void*>(data)), size);
  check_recording(json);
  check_replicate(json);
  return 0;
}
