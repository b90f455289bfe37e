// Any text as a shard's result: an error with words, or a result that is read as it is written.

#include <google/protobuf/util/json_util.h>

#include <cstddef>
#include <cstdint>
#include <cstdlib>
#include <string>

#include "study/batch/batch_folder.h"

namespace {

void require(bool holds) {
  if (!holds) std::abort();
}

std::string written(const imunoise::v1::ShardResult& result) {
  std::string out;
  require(google::protobuf::util::MessageToJsonString(result, &out).ok());
  return out;
}

}  // namespace

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  const std::string text(static_cast<const char*>(static_cast<const void*>(data)), size);
  const auto result = imunoise::study::parse_result(text);
  if (!result) {
    require(!result.error().message.empty());
    return 0;
  }
  const auto again = imunoise::study::parse_result(written(*result));
  require(again.has_value() && written(*again) == written(*result));
  return 0;
}
