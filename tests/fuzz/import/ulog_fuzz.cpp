// Any bytes behind the first ones of a ULog.

#include "tests/fuzz/import/memory_file.h"

using namespace imunoise::recording;

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  return import_behind({"ULog\x01\x12\x35\x01\0\0\0\0\0\0\0\0", 16}, data, size);
}
