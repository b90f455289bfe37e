// Any bytes behind the first ones of every packing.

#include "tests/fuzz/import/memory_file.h"

using namespace imunoise::recording;

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  if (size < 1) return 0;
  constexpr std::string_view begins[] = {
      {"\x1f\x8b\x08\0\0\0\0\0\0\3", 10}, "\x28\xb5\x2f\xfd", "BZh91AY&SY", "\x04\x22\x4d\x18"};
  return import_behind(begins[data[0] % 4U], data + 1, size - 1);
}
