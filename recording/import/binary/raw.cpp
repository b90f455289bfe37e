#include "recording/import/binary/raw.h"

#include <fmt/core.h>

#include <algorithm>
#include <array>
#include <string_view>
#include <utility>

#include "recording/import/binary/binary_table.h"
#include "recording/import/table/file.h"
#include "recording/import/table/format.h"
#include "recording/import/table/sidecar.h"

namespace imunoise::recording {
namespace {

// The extension says the type; .bin leaves it to the sidecar.
constexpr std::array<std::pair<std::string_view, std::string_view>, 5> kExtensions = {
    {{".f64", "<f8"}, {".f32", "<f4"}, {".i16", "<i2"}, {".i32", "<i4"}, {".bin", ""}}};

std::string_view dtype_of(const std::filesystem::path& extension) {
  const auto found = std::find_if(kExtensions.begin(), kExtensions.end(),
                                  [&](const auto& known) { return extension == known.first; });
  return found == kExtensions.end() ? std::string_view() : found->second;
}

Result<bool> has_raw_extension(const UnknownFile& file) {
  return std::any_of(kExtensions.begin(), kExtensions.end(),
                     [&](const auto& known) { return file.extension == known.first; });
}

}  // namespace

Result<Table> read_raw(const std::filesystem::path& path, const ImportOptions& options,
                       FileProgress& progress) {
  const Result<File> file = File::open(path);
  if (!file) return tl::make_unexpected(file.error());
  const auto trouble = [&](const std::string& what) {
    return fail(fmt::format("{}: {}", file->name(), what));
  };
  const Result<std::optional<v1::Sidecar>> sidecar = read_sidecar(path);
  if (!sidecar) return tl::make_unexpected(sidecar.error());
  const std::string where = sidecar_path(path).string();
  if (!*sidecar) {
    return trouble(
        fmt::format("raw numbers need a sidecar {} that says what they are, e.g. "
                    R"({{"rate_hz": 100, "dtype": "<f8", "channels": [{{"name": "gyro_x", )"
                    R"("units": "deg/s"}}]}})",
                    where));
  }
  const std::string_view implied = dtype_of(path.extension());
  const std::string& stated = (*sidecar)->dtype();
  if (!implied.empty() && !stated.empty() && implied != stated) {
    return trouble(
        fmt::format("the extension says {}, but {} says {}; rename the file to .bin or "
                    "correct the sidecar",
                    implied, where, stated));
  }
  const std::optional<NumberType> type = number_type(stated.empty() ? implied : stated);
  if (!type) {
    return trouble(
        fmt::format("{} states dtype '{}'; known are <i2, <i4, <f4, <f8", where, stated));
  }
  if ((*sidecar)->channels().empty()) {
    return trouble(fmt::format("{} names no channels; name each column in order", where));
  }
  BinaryLayout layout;
  layout.type = *type;
  layout.columns = static_cast<std::size_t>((*sidecar)->channels_size());
  const std::uint64_t row = layout.columns * width(*type);
  if (file->size() == 0) return trouble("is empty; record again");
  if (file->size() % row != 0) {
    return trouble(
        fmt::format("{} bytes are not a whole number of rows of {} bytes ({} channels of "
                    "{}); the file is truncated or {} is wrong",
                    file->size(), row, layout.columns, stated.empty() ? implied : stated, where));
  }
  layout.rows = file->size() / row;
  return read_binary_table(*file, layout, *sidecar, options, progress);
}

namespace formats {

const ImportFormat& raw() {
  static constexpr ImportFormat kFormat = {
      .kind = "raw numbers with a sidecar (.f64, .f32, .i16, .i32, .bin)",
      .claims = has_raw_extension,
      .read = read_raw};
  return kFormat;
}

}  // namespace formats

}  // namespace imunoise::recording
