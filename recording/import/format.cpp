#include "recording/import/table/format.h"

#include <fmt/core.h>

#include <array>
#include <string>

#include "recording/import/table/file.h"

// One line a format, in the order in which they are asked: the function in its reader's source that
// describes it. Text comes last: it claims whatever looks like text.
#define IMUNOISE_IMPORT_FORMATS(FORMAT) \
  FORMAT(raw)                           \
  FORMAT(hdf5)                          \
  FORMAT(npy)                           \
  FORMAT(npz)                           \
  FORMAT(matlab5)                       \
  FORMAT(mcap)                          \
  FORMAT(ros1_bag)                      \
  FORMAT(ros2_sqlite)                   \
  FORMAT(ulog)                          \
  FORMAT(candump)                       \
  FORMAT(xbus)                          \
  FORMAT(text)

namespace imunoise::recording {

namespace formats {
#define IMUNOISE_DECLARE(NAME) const ImportFormat& NAME();
IMUNOISE_IMPORT_FORMATS(IMUNOISE_DECLARE)
#undef IMUNOISE_DECLARE
}  // namespace formats

namespace {

const auto& known_formats() {
#define IMUNOISE_LIST(NAME) &formats::NAME(),
  static const std::array kAll{IMUNOISE_IMPORT_FORMATS(IMUNOISE_LIST)};
#undef IMUNOISE_LIST
  return kAll;
}

// "raw numbers (.f64), HDF5 (.h5) or text (.csv)"
std::string known_kinds() {
  const auto& all = known_formats();
  std::string out;
  for (std::size_t i = 0; i < all.size(); ++i) {
    if (i > 0) out += i + 1 < all.size() ? ", " : " or ";
    out += all[i]->kind;
  }
  return out;
}

}  // namespace

Result<const ImportFormat*> detect_format(const std::filesystem::path& path) {
  const Result<File> file = File::open(path);
  if (!file) return tl::make_unexpected(file.error());
  const auto trouble = [&](std::string_view what) {
    return fail(fmt::format("{}: {}", file->name(), what));
  };
  if (file->size() == 0) return trouble("is empty; record again or check how it was exported");
  std::array<char, 4096> bytes = {};
  const Result<std::size_t> got = file->read_at(0, bytes);
  if (!got) return tl::make_unexpected(got.error());
  const UnknownFile unknown{*file, {bytes.data(), *got}, path.extension()};
  if (bytes[0] == '{')
    return trouble("is JSON, no recording; results of imunoise go to imunoise export");
  for (const ImportFormat* const format : known_formats()) {
    if (format->begins != nullptr && format->begins(unknown.head)) return format;
  }
  for (const ImportFormat* const format : known_formats()) {
    const Result<bool> claimed = format->claims(unknown);
    if (!claimed) return tl::make_unexpected(claimed.error());
    if (*claimed) return format;
  }
  return trouble(fmt::format("has an unknown format; known are {}", known_kinds()));
}

}  // namespace imunoise::recording
