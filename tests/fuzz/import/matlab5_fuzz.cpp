// Any bytes behind the header of a MATLAB file, of both byte orders.

#include "tests/fuzz/import/memory_file.h"

using namespace imunoise::recording;

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  if (size < 1) return 0;
  std::string head = "MATLAB 5.0 MAT-file";
  head.resize(124, ' ');
  head += (data[0] & 1U) != 0 ? std::string("\0\1IM", 4) : std::string("\1\0MI", 4);
  return import_behind(head, data + 1, size - 1);
}
