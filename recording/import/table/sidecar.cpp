#include "recording/import/table/sidecar.h"

#include <fmt/core.h>
#include <google/protobuf/util/json_util.h>

#include <cmath>
#include <system_error>

#include "recording/import/table/file.h"

namespace imunoise::recording {
namespace {

constexpr std::uint64_t kMaximumBytes = std::uint64_t{1} << 20U;

constexpr std::string_view kExample =
    R"({"rate_hz": 100, "dtype": "<f8", "channels": [{"name": "gyro_x", "units": "deg/s"}]})";

}  // namespace

std::filesystem::path sidecar_path(const std::filesystem::path& path) {
  std::filesystem::path out = path;
  out += ".json";
  return out;
}

Result<v1::Sidecar> parse_sidecar(std::string_view file, std::string_view json) {
  v1::Sidecar out;
  google::protobuf::util::JsonParseOptions strict;
  strict.ignore_unknown_fields = false;
  const auto status = google::protobuf::util::JsonStringToMessage(
      google::protobuf::StringPiece(json.data(), json.size()), &out, strict);
  if (!status.ok()) {
    return fail(fmt::format("{}: {}; a sidecar reads like {}", file, status.message().ToString(),
                            kExample));
  }
  // 0 stands for "not stated": the user may give the rate.
  if (!std::isfinite(out.rate_hz()) || out.rate_hz() < 0.0) {
    return fail(
        fmt::format("{}: rate_hz {} is not a sampling rate; correct it", file, out.rate_hz()));
  }
  for (const v1::SidecarChannel& channel : out.channels()) {
    if (channel.name().empty()) {
      return fail(fmt::format("{}: a channel has no name; name it", file));
    }
    const double scale = channel.has_scale_factor() ? channel.scale_factor() : 1.0;
    if (!std::isfinite(scale) || scale == 0.0 || !std::isfinite(channel.add_offset())) {
      return fail(fmt::format(
          "{}: channel {}: scale_factor {} and add_offset {} must be finite, the factor not 0",
          file, channel.name(), scale, channel.add_offset()));
    }
  }
  return out;
}

Result<std::optional<v1::Sidecar>> read_sidecar(const std::filesystem::path& path) {
  const std::filesystem::path where = sidecar_path(path);
  std::error_code ignored;
  if (!std::filesystem::exists(where, ignored)) return std::optional<v1::Sidecar>();
  const Result<File> file = File::open(where);
  if (!file) return tl::make_unexpected(file.error());
  if (file->size() > kMaximumBytes) {
    return fail(fmt::format("{}: {} bytes are too many for a sidecar", file->name(), file->size()));
  }
  std::string text(file->size(), '\0');
  const Result<std::size_t> got = file->read_at(0, text);
  if (!got) return tl::make_unexpected(got.error());
  text.resize(*got);
  Result<v1::Sidecar> sidecar = parse_sidecar(file->name(), text);
  if (!sidecar) return tl::make_unexpected(sidecar.error());
  return std::optional(std::move(*sidecar));
}

}  // namespace imunoise::recording
