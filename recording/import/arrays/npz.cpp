#include <fmt/core.h>

#include <algorithm>
#include <array>
#include <optional>
#include <string_view>
#include <utility>

#include "recording/import/arrays/array_table.h"
#include "recording/import/arrays/number_layout.h"
#include "recording/import/arrays/zip.h"
#include "recording/import/binary/npy.h"
#include "recording/import/table/file.h"
#include "recording/import/table/format.h"

// NumPy's .npz: a ZIP archive of .npy files, one an array.

namespace imunoise::recording {
namespace {

constexpr std::string_view kZipMagic = "PK\x03\x04";
constexpr std::size_t kMostArrays = 4096;

// "<f8", ">i2", "|u1"; nothing for text, objects and complex numbers.
std::optional<NumberLayout> layout_called(std::string_view dtype) {
  if (dtype.size() != 3 || (dtype[0] != '<' && dtype[0] != '>' && dtype[0] != '|'))
    return std::nullopt;
  NumberLayout out{NumberLayout::Kind::kFloat, static_cast<std::size_t>(dtype[2] - '0'),
                   dtype[0] == '>'};
  const bool width = out.width == 1 || out.width == 2 || out.width == 4 || out.width == 8;
  if (dtype[1] == 'f') return width && out.width >= 4 ? std::optional(out) : std::nullopt;
  if (dtype[1] != 'i' && dtype[1] != 'u') return std::nullopt;
  out.kind = dtype[1] == 'i' ? NumberLayout::Kind::kSigned : NumberLayout::Kind::kUnsigned;
  return width ? std::optional(out) : std::nullopt;
}

struct NpzArray {
  NamedArray array;
  ZipMember member;
  std::uint64_t begin = 0;  // bytes of the member before its numbers
  NumberLayout layout;
  std::uint64_t count = 0;
};

class NpzFile {
 public:
  explicit NpzFile(const File& file) : file_(file) {}

  Result<Table> read(const ImportOptions& options, FileProgress& progress) {
    if (auto known = learn(); !known) return tl::make_unexpected(known.error());
    std::vector<NamedArray> names;
    for (const NpzArray& one : arrays_) names.push_back(one.array);
    if (names.empty()) {
      return fail(
          fmt::format("{}: holds no array of numbers of one or two dimensions; save one "
                      "with numpy.savez",
                      file_.name()));
    }
    auto table = ArrayTable::choose(file_.name(), std::move(names), options);
    if (!table) return tl::make_unexpected(table.error());
    for (std::size_t a = 0; a < arrays_.size(); ++a) {
      if (progress.stopped()) return fail(fmt::format("{}: the import was stopped", file_.name()));
      const auto take = [&](double number) { table->take(a, number); };
      if (!table->wants(a)) continue;
      if (auto done = numbers(arrays_[a], take); !done) return tl::make_unexpected(done.error());
      progress.report(static_cast<double>(a + 1) / static_cast<double>(arrays_.size()));
    }
    Result<Table> out = table->finish();
    if (out) out->notes.insert(out->notes.end(), notes_.begin(), notes_.end());
    return out;
  }

 private:
  static bool is_array(const ZipMember& member) {
    return std::string_view(member.name).ends_with(".npy");
  }

  // Other programs save ZIP archives, too.
  tl::unexpected<Error> refuse(const std::vector<ZipMember>& members) const {
    const bool spreadsheet = std::any_of(members.begin(), members.end(), [](const ZipMember& one) {
      return one.name.starts_with("xl/") || one.name == "content.xml";
    });
    return fail(fmt::format("{}: {}", file_.name(),
                            spreadsheet ? "is a spreadsheet: save its table as CSV"
                                        : "is a ZIP archive without NumPy arrays: unpack it, and "
                                          "name the files in it"));
  }

  // Finds the arrays, and reads those of one number.
  Result<void> learn() {
    Result<std::vector<ZipMember>> members = zip_members(file_);
    if (!members) return tl::make_unexpected(members.error());
    if (std::none_of(members->begin(), members->end(), is_array)) return refuse(*members);
    for (ZipMember& member : *members) {
      if (!is_array(member) || arrays_.size() == kMostArrays) continue;
      const auto stream = open_member(file_, member);
      if (!stream) return tl::make_unexpected(stream.error());
      const Result<NpyPreamble> preamble = read_npy_preamble(file_.name(), **stream);
      if (!preamble) return tl::make_unexpected(preamble.error());
      const std::string name = member.name.substr(0, member.name.size() - 4);
      const Result<NpyHeader> header = parse_npy_header(preamble->dictionary);
      const auto layout = header ? layout_called(header->dtype) : std::nullopt;
      if (!layout || header->shape.size() > 2) {
        notes_.push_back(
            fmt::format("array {} holds no numbers of one or two dimensions: left out", name));
        continue;
      }
      NpzArray one{{name, {}, header->fortran_order}, std::move(member), preamble->end, *layout};
      const auto& shape = header->shape;
      one.array.shape.rows = shape.empty() ? 1 : shape[0];
      one.array.shape.columns = shape.size() < 2 ? 1 : shape[1];
      if (__builtin_mul_overflow(one.array.shape.rows, one.array.shape.columns, &one.count))
        return fail(fmt::format("{}: array {} is damaged; save it again", file_.name(), name));
      if (one.count == 0) continue;
      if (one.count == 1) {
        const auto take = [&](double number) { one.array.number = number; };
        if (auto done = numbers(one, take); !done) return done;
      }
      arrays_.push_back(std::move(one));
    }
    return {};
  }

  template <class Take>
  Result<void> numbers(const NpzArray& array, const Take& take) const {
    const auto stream = open_member(file_, array.member);
    if (!stream) return tl::make_unexpected(stream.error());
    const Result<std::uint64_t> passed = (*stream)->skip(array.begin);
    if (!passed) return tl::make_unexpected(passed.error());
    std::array<char, 8192> block;
    const std::size_t width = array.layout.width;
    for (std::uint64_t left = array.count; left > 0;) {
      const std::uint64_t step = std::min<std::uint64_t>(block.size() / width, left);
      const Result<std::size_t> got = (*stream)->read(std::span(block).first(step * width));
      if (!got) return tl::make_unexpected(got.error());
      for (std::size_t i = 0; i + width <= *got; i += width)
        take(number_at(block.data() + i, array.layout));
      if (*got < step * width) break;  // the table misses what is not there
      left -= step;
    }
    return {};
  }

  const File& file_;
  std::vector<NpzArray> arrays_;
  std::vector<std::string> notes_;
};

Result<Table> read_npz(const std::filesystem::path& path, const ImportOptions& options,
                       FileProgress& progress) {
  const Result<File> file = File::open(path);
  if (!file) return tl::make_unexpected(file.error());
  return NpzFile(*file).read(options, progress);
}

Result<bool> claims_npz(const UnknownFile& file) {
  if (file.extension != ".npz") return false;
  return fail(fmt::format("{}: is not a NumPy archive, despite its name; save it again",
                          file.content.name()));
}

}  // namespace

namespace formats {

const ImportFormat& npz() {
  static constexpr ImportFormat kFormat = {
      .kind = "NumPy (.npz)",
      .begins = [](std::string_view head) { return head.starts_with(kZipMagic); },
      .claims = claims_npz,
      .read = read_npz};
  return kFormat;
}

}  // namespace formats

}  // namespace imunoise::recording
