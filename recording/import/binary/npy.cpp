#include "recording/import/binary/npy.h"

#include <fmt/core.h>

#include <array>
#include <utility>

#include "recording/import/binary/binary_table.h"
#include "recording/import/table/file.h"
#include "recording/import/table/format.h"
#include "recording/import/table/sidecar.h"

namespace imunoise::recording {
namespace {

// Text of the dictionary, and where the numbers begin.
struct Preamble {
  std::string dictionary;
  std::uint64_t end = 0;
};

// The dictionary of an array of numbers has 200 bytes; only named fields, which are refused, need
// more.
constexpr std::uint64_t kLongestDictionary = std::uint64_t{64} << 10U;

Result<Preamble> read_preamble(const File& file) {
  const auto truncated = [&] {
    return fail(fmt::format("{}: ends within its .npy header; copy or save it again", file.name()));
  };
  std::array<char, 12> start = {};
  const Result<std::size_t> got = file.read_at(0, start);
  if (!got) return tl::make_unexpected(got.error());
  if (*got < start.size()) return truncated();
  const auto byte = [&](std::size_t i) {
    return std::uint64_t{static_cast<unsigned char>(start[i])};
  };
  const std::uint64_t major = byte(6);
  if (major < 1 || major > 3) {
    return fail(fmt::format("{}: .npy version {}, known are 1, 2 and 3; save it with another NumPy",
                            file.name(), major));
  }
  std::uint64_t length = byte(8) | byte(9) << 8U;
  const std::uint64_t begin = major == 1 ? 10 : 12;
  if (major > 1) length |= byte(10) << 16U | byte(11) << 24U;
  if (length > file.size() - begin) return truncated();
  if (length > kLongestDictionary) {
    return fail(
        fmt::format("{}: a .npy header of {} bytes, at most {} are read; save it again with "
                    "numpy.save",
                    file.name(), length, kLongestDictionary));
  }
  Preamble out{std::string(length, '\0'), begin + length};
  const Result<std::size_t> text = file.read_at(begin, out.dictionary);
  if (!text) return tl::make_unexpected(text.error());
  if (*text != length) return truncated();
  return out;
}

Result<bool> claims_npy(const UnknownFile& file) {
  if (file.extension != ".npy") return false;
  return fail(
      fmt::format("{}: is not a NumPy file, despite its name; save it again", file.content.name()));
}

}  // namespace

Result<Table> read_npy(const std::filesystem::path& path, const ImportOptions& options,
                       FileProgress& progress) {
  const Result<File> file = File::open(path);
  if (!file) return tl::make_unexpected(file.error());
  const auto trouble = [&](const std::string& what) {
    return fail(fmt::format("{}: {}", file->name(), what));
  };
  const Result<Preamble> preamble = read_preamble(*file);
  if (!preamble) return tl::make_unexpected(preamble.error());
  const Result<NpyHeader> header = parse_npy_header(preamble->dictionary);
  if (!header) return trouble(header.error().message);
  const std::optional<NumberType> type = number_type(header->dtype);
  if (!type) {
    return trouble(
        fmt::format("numbers of type '{}'; known are <i2, <i4, <f4, <f8: convert with "
                    "numpy.save(path, array.astype('<f8'))",
                    header->dtype));
  }
  if (header->shape.empty() || header->shape.size() > 2) {
    return trouble(
        fmt::format("an array of {} dimensions; save one of shape (samples,) or (samples, "
                    "channels)",
                    header->shape.size()));
  }
  BinaryLayout layout;
  layout.type = *type;
  layout.begin = preamble->end;
  layout.rows = header->shape[0];
  layout.columns = header->shape.size() == 2 ? header->shape[1] : 1;
  layout.column_major = header->fortran_order;
  const std::uint64_t payload = file->size() - preamble->end;
  std::uint64_t claimed = 0;
  if (__builtin_mul_overflow(layout.rows, layout.columns, &claimed) ||
      __builtin_mul_overflow(claimed, width(*type), &claimed) || claimed != payload) {
    return trouble(
        fmt::format("the header announces {} x {} numbers of {} bytes, but {} bytes follow; "
                    "the file is truncated or damaged: copy or save it again",
                    layout.rows, layout.columns, width(*type), payload));
  }
  if (claimed == 0) return trouble("holds no samples; check how it was exported");
  const Result<std::optional<v1::Sidecar>> sidecar = read_sidecar(path);
  if (!sidecar) return tl::make_unexpected(sidecar.error());
  if (*sidecar && !(*sidecar)->dtype().empty() && (*sidecar)->dtype() != header->dtype) {
    return trouble(fmt::format("numbers of type {}, but {} says {}; correct the sidecar",
                               header->dtype, sidecar_path(path).string(), (*sidecar)->dtype()));
  }
  return read_binary_table(*file, layout, *sidecar, options, progress);
}

namespace formats {

const ImportFormat& npy() {
  static constexpr ImportFormat kFormat = {
      .kind = "NumPy (.npy)",
      .begins = [](std::string_view head) { return head.starts_with(kNpyMagic); },
      .claims = claims_npy,
      .read = read_npy};
  return kFormat;
}

}  // namespace formats

}  // namespace imunoise::recording
