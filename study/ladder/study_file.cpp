#include "study/ladder/study_file.h"

#include <fmt/format.h>
#include <google/protobuf/util/json_util.h>

#include <fstream>
#include <iterator>

namespace imunoise::study {
namespace {

constexpr std::uint32_t kVersion = 1;

// What a file must hold so that no place in it leads nowhere.
bool sound(const v1::Study& study) {
  const auto count = static_cast<std::uint32_t>(study.attempts_size());
  if (study.current() >= count) return false;
  for (std::uint32_t i = 0; i < count; ++i) {
    const v1::StudyAttempt& attempt = study.attempts(static_cast<int>(i));
    if (attempt.has_parent() ? attempt.parent() >= i : i != 0) return false;
  }
  return true;
}

}  // namespace

Result<v1::Study> parse_study(const std::string& text) {
  v1::Study out;
  google::protobuf::util::JsonParseOptions strict;
  strict.ignore_unknown_fields = false;
  const auto status = google::protobuf::util::JsonStringToMessage(text, &out, strict);
  if (!status.ok()) return fail("not a study: " + std::string(status.message()));
  if (out.version() != kVersion)
    return fail(
        fmt::format("version {} of a study file; this program reads {}", out.version(), kVersion));
  if (!sound(out)) return fail("its attempts refer to attempts that do not exist");
  return out;
}

Result<v1::Study> read_study(const std::filesystem::path& file) {
  std::ifstream in(file, std::ios::binary);
  const std::string text(std::istreambuf_iterator<char>(in), {});
  if (!in.is_open() || in.bad())
    return fail(file.string() + ": cannot be read; check the path and its permissions");
  auto out = parse_study(text);
  if (!out) return fail(file.string() + ": " + out.error().message);
  return out;
}

std::string study_text(const v1::Study& study) {
  std::string out;
  google::protobuf::util::JsonPrintOptions options;
  options.add_whitespace = true;
  options.preserve_proto_field_names = true;
  // Numbers that are not finite have no place in JSON; the analysis leaves them out.
  const auto status = google::protobuf::util::MessageToJsonString(study, &out, options);
  return status.ok() ? out : std::string();
}

}  // namespace imunoise::study
