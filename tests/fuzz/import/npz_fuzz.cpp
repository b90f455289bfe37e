// Any bytes as an archive of NumPy, or as the only array in a sound one.

#include "tests/fuzz/import/memory_file.h"

using namespace imunoise::recording;

namespace {

// Little-endian.
std::string number(std::size_t value, std::size_t bytes) {
  std::string out;
  for (std::size_t i = 0; i < bytes; ++i)
    out += static_cast<char>(i < sizeof value ? value >> (8 * i) & 0xffU : 0);
  return out;
}

}  // namespace

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  if (size < 1) return 0;
  const std::string_view bytes = bytes_at(data + 1, size - 1);
  if ((data[0] & 1U) == 0) return import_behind("PK\3\4", data + 1, size - 1);
  const bool deflated = (data[0] & 2U) != 0;
  const std::string local = std::string("PK\3\4", 4) + number(20, 2) + number(0, 2) +
                            number(deflated ? 8 : 0, 2) + number(0, 8) + number(bytes.size(), 4) +
                            number(bytes.size(), 4) + number(5, 2) + number(0, 2) + "a.npy";
  const std::string entry = std::string("PK\1\2", 4) + number(20, 4) + number(0, 2) +
                            number(deflated ? 8 : 0, 2) + number(0, 8) + number(bytes.size(), 4) +
                            number(bytes.size(), 4) + number(5, 2) + number(0, 2 + 2 + 8) +
                            number(0, 4) + "a.npy";
  std::string file = local;
  file += bytes;
  const std::size_t directory = file.size();
  file += entry + std::string("PK\5\6", 4) + number(0, 4) + number(1, 2) + number(1, 2) +
          number(entry.size(), 4) + number(directory, 4) + number(0, 2);
  const MemoryFile archive(file);
  require_sound_import(archive.path());
  return 0;
}
