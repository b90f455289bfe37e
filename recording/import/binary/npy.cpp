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

// The dictionary of an array of numbers has 200 bytes; only named fields, which are refused, need
// more.
constexpr std::uint64_t kLongestDictionary = std::uint64_t{64} << 10U;

Result<bool> claims_npy(const UnknownFile& file) {
  if (file.extension != ".npy") return false;
  return fail(
      fmt::format("{}: is not a NumPy file, despite its name; save it again", file.content.name()));
}

}  // namespace

Result<NpyPreamble> read_npy_preamble(const std::string& name, ByteStream& from) {
  const auto truncated = [&] {
    return fail(fmt::format("{}: ends within its .npy header; copy or save it again", name));
  };
  std::array<char, 12> start = {};
  const auto take = [&](std::span<char> out) -> Result<bool> {
    const Result<std::size_t> got = from.read(out);
    if (!got) return tl::make_unexpected(got.error());
    return *got == out.size();
  };
  Result<bool> whole = take(std::span(start).first(10));
  if (!whole) return tl::make_unexpected(whole.error());
  if (!*whole) return truncated();
  const auto byte = [&](std::size_t i) {
    return std::uint64_t{static_cast<unsigned char>(start[i])};
  };
  const std::uint64_t major = byte(6);
  if (major < 1 || major > 3) {
    return fail(fmt::format("{}: .npy version {}, known are 1, 2 and 3; save it with another NumPy",
                            name, major));
  }
  const std::uint64_t begin = major == 1 ? 10 : 12;
  if (major > 1) whole = take(std::span(start).last(2));
  if (!whole) return tl::make_unexpected(whole.error());
  std::uint64_t length = byte(8) | byte(9) << 8U;
  if (major > 1) length |= byte(10) << 16U | byte(11) << 24U;
  if (*whole && length > kLongestDictionary) {
    return fail(
        fmt::format("{}: a .npy header of {} bytes, at most {} are read; save it again with "
                    "numpy.save",
                    name, length, kLongestDictionary));
  }
  NpyPreamble out{std::string(length, '\0'), begin + length};
  if (*whole) whole = take(out.dictionary);
  if (!whole) return tl::make_unexpected(whole.error());
  if (!*whole) return truncated();
  return out;
}

Result<Table> read_npy(const std::filesystem::path& path, const ImportOptions& options,
                       FileProgress& progress) {
  const Result<File> file = File::open(path);
  if (!file) return tl::make_unexpected(file.error());
  const auto trouble = [&](const std::string& what) {
    return fail(fmt::format("{}: {}", file->name(), what));
  };
  FileStream head(*file, 0, file->size());
  const Result<NpyPreamble> preamble = read_npy_preamble(file->name(), head);
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
  // Channels by samples: no sensor has more channels than samples.
  const bool across = layout.columns > kMinimumSamples && layout.columns > 16 * layout.rows;
  if (across) {
    std::swap(layout.rows, layout.columns);
    layout.column_major = !layout.column_major;
  }
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
