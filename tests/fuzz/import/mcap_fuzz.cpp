// Any bytes behind the first ones of an MCAP file.

#include "tests/fuzz/import/memory_file.h"

using namespace imunoise::recording;

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  return import_behind("\x89MCAP0\r\n", data, size);
}
