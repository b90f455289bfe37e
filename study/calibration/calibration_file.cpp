#include "study/calibration/calibration_file.h"

#include <fmt/format.h>
#include <google/protobuf/util/json_util.h>

#include "study/report/json.h"

namespace imunoise::study {

Result<v1::Calibration> parse_calibration(const std::string& text) {
  v1::Calibration out;
  google::protobuf::util::JsonParseOptions strict;
  strict.ignore_unknown_fields = false;
  const auto status = google::protobuf::util::JsonStringToMessage(text, &out, strict);
  if (!status.ok()) return fail("not a calibration: " + status.message().ToString());
  if (out.version() != kCalibrationVersion) {
    return fail(fmt::format("version {} of a calibration; this program reads {}", out.version(),
                            kCalibrationVersion));
  }
  return out;
}

Result<std::optional<v1::Calibration>> read_calibration(const recording::FileSystem& files,
                                                        const std::filesystem::path& root) {
  const auto there = recording::contains(files, root, kCalibrationName);
  if (!there) return tl::unexpected(there.error());
  if (!*there) return std::optional<v1::Calibration>();
  const std::filesystem::path path = root / kCalibrationName;
  const auto text = files.read(path);
  if (!text) return tl::unexpected(text.error());
  auto out = parse_calibration(*text);
  if (!out) {
    return fail(fmt::format("{}: {}; imunoise calibrate makes it again", path.string(),
                            out.error().message));
  }
  return std::optional(std::move(*out));
}

Result<void> write_calibration(recording::FileSystem& files, const std::filesystem::path& root,
                               const v1::Calibration& calibration) {
  return recording::replace_file(files, root / kCalibrationName, report::to_json(calibration));
}

}  // namespace imunoise::study
