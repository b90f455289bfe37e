// Any text as calibration.json: an error with words, or a calibration that is read as it is
// written.

#include <google/protobuf/util/json_util.h>

#include <cstddef>
#include <cstdint>
#include <cstdlib>
#include <string>

#include "study/calibration/calibration_file.h"

namespace {

void require(bool holds) {
  if (!holds) std::abort();
}

std::string written(const imunoise::v1::Calibration& calibration) {
  std::string out;
  require(google::protobuf::util::MessageToJsonString(calibration, &out).ok());
  return out;
}

}  // namespace

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  const std::string text(static_cast<const char*>(static_cast<const void*>(data)), size);
  const auto calibration = imunoise::study::parse_calibration(text);
  if (!calibration) {
    require(!calibration.error().message.empty());
    return 0;
  }
  require(calibration->version() == imunoise::study::kCalibrationVersion);
  const auto again = imunoise::study::parse_calibration(written(*calibration));
  require(again.has_value() && written(*again) == written(*calibration));
  return 0;
}
