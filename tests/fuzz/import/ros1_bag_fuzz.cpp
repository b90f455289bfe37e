// Any bytes behind the first ones of a ROS 1 bag.

#include "tests/fuzz/import/memory_file.h"

using namespace imunoise::recording;

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  return import_behind("#ROSBAG V2.0\n", data, size);
}
