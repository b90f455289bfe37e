// Any bytes behind the first ones of a ROS 1 bag: no crash, no number that is not finite.

#include <cstdint>
#include <string>
#include <string_view>

#include "recording/import/import.h"
#include "tests/fuzz/memory_file.h"

using namespace imunoise;
using namespace imunoise::recording;

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  const std::string_view bytes(static_cast<const char*>(static_cast<const void*>(data)), size);
  const MemoryFile file(std::string("#ROSBAG V2.0\n").append(bytes));
  ImportOptions options;
  options.rate = Hertz{100.0};
  const std::filesystem::path paths[] = {file.path()};
  const auto got = import_files(paths, options);
  if (got) {
    for (const Channel& channel : got->front().channels) require_finite(channel);
  }
  return 0;
}
