#include "recording/import/format.h"

#include <fmt/core.h>

#include <algorithm>
#include <array>
#include <string>

#include "recording/import/file.h"
#include "recording/import/npy.h"
#include "recording/import/raw.h"

namespace imunoise::recording {
namespace {

constexpr std::string_view kHdf5Magic = "\x89HDF\r\n\x1a\n";

constexpr std::array kHdf5Extensions = {".h5", ".hdf5", ".hdf", ".nc", ".mat"};
constexpr std::array kTextExtensions = {".csv", ".tsv", ".txt", ".dat"};

template <class List>
bool contains(const List& list, const std::filesystem::path& extension) {
  return std::any_of(list.begin(), list.end(),
                     [&](const char* known) { return extension == known; });
}

// HDF5 allows a block of the user's before its own magic, at 512 bytes or a doubling of that.
Result<bool> is_hdf5(const File& file) {
  for (std::uint64_t at = 0; at < file.size(); at = at == 0 ? 512 : 2 * at) {
    std::array<char, 8> magic = {};
    const Result<std::size_t> got = file.read_at(at, magic);
    if (!got) return tl::make_unexpected(got.error());
    if (std::string_view(magic.data(), *got) == kHdf5Magic) return true;
  }
  return false;
}

}  // namespace

Result<Format> detect_format(const std::filesystem::path& path) {
  const Result<File> file = File::open(path);
  if (!file) return tl::make_unexpected(file.error());
  const auto trouble = [&](std::string_view what) {
    return fail(fmt::format("{}: {}", file->name(), what));
  };
  if (file->size() == 0) return trouble("is empty; record again or check how it was exported");
  std::array<char, 4096> bytes = {};
  const Result<std::size_t> got = file->read_at(0, bytes);
  if (!got) return tl::make_unexpected(got.error());
  const std::string_view head(bytes.data(), *got);
  const std::filesystem::path extension = path.extension();

  const bool raw = is_raw_extension(extension);
  if (head.starts_with(kNpyMagic)) return Format::kNpy;
  if (head.starts_with(kHdf5Magic)) return Format::kHdf5;
  if (raw) return Format::kRaw;
  const Result<bool> hdf5 = is_hdf5(*file);
  if (!hdf5) return tl::make_unexpected(hdf5.error());
  if (*hdf5) return Format::kHdf5;
  if (contains(kHdf5Extensions, extension)) {
    return trouble(
        "is not an HDF5 file, despite its name (a MATLAB file must be saved as v7.3); "
        "it may be truncated: copy it again");
  }
  if (extension == ".npy") return trouble("is not a NumPy file, despite its name; save it again");
  const bool text = std::none_of(head.begin(), head.end(), [](char c) { return c == '\0'; });
  if (text || contains(kTextExtensions, extension)) return Format::kText;
  return trouble(
      "has an unknown format; known are HDF5 (.h5), NumPy (.npy), text (.csv, .tsv, .txt, .dat) or "
      "raw "
      "numbers with a sidecar (.f64, .f32, .i16, .i32, .bin)");
}

}  // namespace imunoise::recording
