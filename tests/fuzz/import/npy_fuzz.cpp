// Any bytes as a .npy file: no crash, no allocation beyond the file's size, no number that is not
// finite.

#include <cstdint>

#include "recording/import/binary/npy.h"
#include "tests/fuzz/import/memory_file.h"

using namespace imunoise::recording;

namespace {

// The first byte chooses: the rest as it is, or as a dictionary with a correct frame around it.
std::string framed(std::string_view bytes) {
  const bool frame = (static_cast<unsigned char>(bytes.front()) & 1U) != 0;
  bytes.remove_prefix(1);
  std::string out(kNpyMagic);
  if (!frame) return out += bytes;
  const std::size_t close = bytes.find('}');
  const std::size_t length = close == std::string_view::npos ? bytes.size() : close + 1;
  out += {'\1', '\0', static_cast<char>(length % 256), static_cast<char>(length / 256 % 256)};
  return out += bytes;
}

}  // namespace

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  if (size < 1) return 0;
  const MemoryFile file(framed({static_cast<const char*>(static_cast<const void*>(data)), size}));
  require_sound_import(file.path());
  return 0;
}
