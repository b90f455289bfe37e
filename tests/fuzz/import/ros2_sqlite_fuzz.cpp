// Any bytes behind the first ones of a database of SQLite.

#include "tests/fuzz/import/memory_file.h"

using namespace imunoise::recording;

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  const NamedFile file(std::string("SQLite format 3\0", 16).append(bytes_at(data, size)));
  require_sound_import(NamedFile::path());
  return 0;
}
