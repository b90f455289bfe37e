#include <fmt/core.h>

#include <array>
#include <cstring>
#include <memory>
#include <set>
#include <string_view>
#include <utility>

#include "recording/import/arrays/array_table.h"
#include "recording/import/arrays/matrix_reader.h"
#include "recording/import/packed/unpacking.h"
#include "recording/import/table/file.h"
#include "recording/import/table/format.h"

// MATLAB files of versions 5 to 7: top-level elements, each a matrix or a matrix that is packed
// with zlib. They are walked through twice: what there is, then the numbers that are wanted.

namespace imunoise::recording {
namespace {

constexpr std::uint32_t kPlainMatrix = 14;
constexpr std::uint32_t kPackedMatrix = 15;

class MatlabFile {
 public:
  MatlabFile(const File& file, bool swap) : file_(file), swap_(swap) {}

  // Visits every matrix. False: the file broke off.
  Result<bool> walk(const MatrixVisitor& visitor, const FileProgress& progress) const {
    MatrixReader reader(visitor, swap_);
    std::uint64_t place = kMatlabHeader;
    while (place < file_.size()) {
      if (progress.stopped()) return fail("the import was stopped");
      FileStream head(file_, place, 8);
      std::uint32_t type = 0;
      std::uint32_t bytes = 0;
      const Result<bool> there = words(head, type, bytes);
      if (!there || !*there) return there;
      place += 8;
      const std::uint64_t count = std::min<std::uint64_t>(bytes, file_.size() - place);
      Result<bool> whole = true;
      if (type == kPlainMatrix) {
        FileStream content(file_, place, bytes);
        whole = reader.matrix(content, bytes);
      } else if (type == kPackedMatrix) {
        whole = packed(reader, place, count);
      }
      if (!whole || !*whole || count < bytes) return whole ? Result<bool>(false) : whole;
      place += bytes;
    }
    return true;
  }

 private:
  Result<bool> words(ByteStream& stream, std::uint32_t& first, std::uint32_t& second) const {
    std::array<char, 8> raw;
    const Result<std::size_t> got = stream.read(raw);
    if (!got) return tl::make_unexpected(got.error());
    if (*got < raw.size()) return false;
    if (swap_) {
      std::reverse(raw.begin(), raw.begin() + 4);
      std::reverse(raw.begin() + 4, raw.end());
    }
    std::memcpy(&first, raw.data(), 4);
    std::memcpy(&second, raw.data() + 4, 4);
    return true;
  }

  Result<bool> packed(MatrixReader& reader, std::uint64_t place, std::uint64_t count) const {
    const auto content =
        unpacking(Packing::kZlib, std::make_unique<FileStream>(file_, place, count), file_.name());
    if (!content) return fail("needs more memory than available");
    std::uint32_t type = 0;
    std::uint32_t bytes = 0;
    const Result<bool> there = words(*content, type, bytes);
    if (!there || !*there || type != kPlainMatrix) return there;
    return reader.matrix(*content, bytes);
  }

  const File& file_;
  bool swap_;
};

struct Contents {
  std::vector<NamedArray> arrays;
  std::set<std::string> notes;
  bool truncated = false;
};

// What there is. A matrix that breaks off is the last one, and does not count.
Result<Contents> contents_of(const MatlabFile& file, const FileProgress& progress) {
  Contents out;
  std::vector<NamedArray> seen;
  const MatrixVisitor visitor{.begin =
                                  [&](const NamedArray& array, std::size_t) {
                                    seen.push_back(array);
                                    return false;
                                  },
                              .number = [](std::size_t, double) {},
                              .end = [&](std::size_t index) { out.arrays.push_back(seen[index]); },
                              .note =
                                  [&](std::string note) {
                                    if (out.notes.size() < 20) out.notes.insert(std::move(note));
                                  }};
  const Result<bool> whole = file.walk(visitor, progress);
  if (!whole) return tl::make_unexpected(whole.error());
  out.truncated = !*whole;
  return out;
}

Result<Table> table_of(const File& file, bool swap, const ImportOptions& options,
                       FileProgress& progress) {
  const auto trouble = [&](const Error& error) {
    const bool named = error.message.starts_with(file.name());
    return fail(named ? error.message : fmt::format("{}: {}", file.name(), error.message));
  };
  const MatlabFile matlab(file, swap);
  Result<Contents> contents = contents_of(matlab, progress);
  if (!contents) return trouble(contents.error());
  progress.report(0.3);
  if (contents->arrays.empty()) {
    std::string notes;
    for (const std::string& one : contents->notes) notes += "; " + one;
    return fail(fmt::format("{}: holds no whole matrix of numbers{}", file.name(), notes));
  }
  const std::size_t whole = contents->arrays.size();
  auto table = ArrayTable::choose(file.name(), std::move(contents->arrays), options);
  if (!table && contents->truncated)
    return fail(table.error().message + "; the file is truncated: copy it again");
  if (!table) return tl::make_unexpected(table.error());
  const MatrixVisitor visitor{
      .begin = [&](const NamedArray&,
                   std::size_t index) { return index < whole && table->wants(index); },
      .number = [&](std::size_t index, double number) { table->take(index, number); },
      .end = [](std::size_t) {},
      .note = [](const std::string&) {}};
  const Result<bool> read = matlab.walk(visitor, progress);
  if (!read) return trouble(read.error());
  Result<Table> out = table->finish();
  if (!out) return out;
  out->truncated = contents->truncated;
  out->notes.insert(out->notes.end(), contents->notes.begin(), contents->notes.end());
  return out;
}

constexpr std::string_view kMatlabMagic = "MATLAB 5.0 MAT-file";

Result<Table> read_matlab5(const std::filesystem::path& path, const ImportOptions& options,
                           FileProgress& progress) {
  const Result<File> file = File::open(path);
  if (!file) return tl::make_unexpected(file.error());
  std::array<char, 4> mark = {};
  const Result<std::size_t> got = file->read_at(kMatlabHeader - mark.size(), mark);
  if (!got) return tl::make_unexpected(got.error());
  const std::string_view order(mark.data() + 2, 2);
  if (order != "IM" && order != "MI") {
    return fail(
        fmt::format("{}: ends within its header, or is damaged; save it again", file->name()));
  }
  return table_of(*file, order == "MI", options, progress);
}

Result<bool> claims_matlab5(const UnknownFile&) { return false; }

}  // namespace

namespace formats {

const ImportFormat& matlab5() {
  static constexpr ImportFormat kFormat = {
      .kind = "MATLAB (.mat)",
      .begins = [](std::string_view head) { return head.starts_with(kMatlabMagic); },
      .claims = claims_matlab5,
      .read = read_matlab5};
  return kFormat;
}

}  // namespace formats

}  // namespace imunoise::recording
