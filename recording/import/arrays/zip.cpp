#include "recording/import/arrays/zip.h"

#include <fmt/core.h>

#include <algorithm>

#include "recording/import/packed/unpacking.h"
#include "recording/import/table/bytes.h"

namespace imunoise::recording {
namespace {

constexpr std::uint32_t kWideEndMark = 0x06064b50;
constexpr std::uint32_t kWidePlaceMark = 0x07064b50;
constexpr std::uint32_t kMemberMark = 0x02014b50;
constexpr std::uint32_t kLocalMark = 0x04034b50;
constexpr std::uint64_t kEndBytes = 22;
constexpr std::uint64_t kLongestComment = 65535;
constexpr std::uint64_t kLongestDirectory = std::uint64_t{16} << 20U;
constexpr std::uint32_t kWide = 0xffffffff;  // the number stands in the extra field
constexpr std::uint16_t kWideExtra = 1;

tl::unexpected<Error> damaged_zip(const File& file) {
  return fail(
      fmt::format("{}: its archive is truncated or damaged; copy or save it again", file.name()));
}

struct Directory {
  std::uint64_t begin = 0;
  std::uint64_t bytes = 0;
};

Result<std::string> zip_bytes(const File& file, std::uint64_t begin, std::uint64_t count) {
  if (begin > file.size() || count > file.size() - begin) return damaged_zip(file);
  std::string out(count, '\0');
  const Result<std::size_t> got = file.read_at(begin, out);
  if (!got) return tl::make_unexpected(got.error());
  if (*got != count) return damaged_zip(file);
  return out;
}

// Archives beyond 4 GiB say it again, wider.
Result<Directory> wide_directory(const File& file, std::uint64_t end) {
  if (end < 20) return damaged_zip(file);
  const Result<std::string> place = zip_bytes(file, end - 20, 20);
  if (!place) return tl::make_unexpected(place.error());
  Fields at(*place);
  if (at.number<std::uint32_t>() != kWidePlaceMark) return damaged_zip(file);
  at.number<std::uint32_t>();  // disk
  const Result<std::string> record = zip_bytes(file, at.number<std::uint64_t>(), 56);
  if (!record) return tl::make_unexpected(record.error());
  Fields fields(*record);
  if (fields.number<std::uint32_t>() != kWideEndMark) return damaged_zip(file);
  fields.bytes(36);  // sizes, versions, disks, counts
  Directory out;
  out.bytes = fields.number<std::uint64_t>();
  out.begin = fields.number<std::uint64_t>();
  return out;
}

Result<Directory> directory_of(const File& file) {
  const std::uint64_t most = std::min(file.size(), kEndBytes + kLongestComment);
  const Result<std::string> tail = zip_bytes(file, file.size() - most, most);
  if (!tail) return tl::make_unexpected(tail.error());
  const std::size_t at = tail->rfind("PK\x05\x06");
  if (at == std::string::npos || tail->size() - at < kEndBytes) return damaged_zip(file);
  Fields fields(std::string_view(*tail).substr(at));
  fields.number<std::uint32_t>();  // the mark
  fields.bytes(8);                 // disks, counts
  Directory out;
  out.bytes = fields.number<std::uint32_t>();
  out.begin = fields.number<std::uint32_t>();
  if (out.begin == kWide || out.bytes == kWide)
    return wide_directory(file, file.size() - most + at);
  return out;
}

// Sizes and places that did not fit into 32 bits stand there, in this order.
void widen(std::string_view extra, ZipMember& member) {
  Fields fields(extra);
  while (fields.ok() && !fields.rest().empty()) {
    const auto kind = fields.number<std::uint16_t>();
    Fields content(fields.counted<std::uint16_t>());
    if (kind != kWideExtra) continue;
    for (std::uint64_t* const one : {&member.bytes, &member.packed, &member.header}) {
      if (*one == kWide) *one = content.number<std::uint64_t>();
    }
  }
}

}  // namespace

Result<std::vector<ZipMember>> zip_members(const File& file) {
  const Result<Directory> directory = directory_of(file);
  if (!directory) return tl::make_unexpected(directory.error());
  if (directory->bytes > kLongestDirectory) return damaged_zip(file);
  const Result<std::string> text = zip_bytes(file, directory->begin, directory->bytes);
  if (!text) return tl::make_unexpected(text.error());
  std::vector<ZipMember> out;
  Fields fields(*text);
  while (!fields.rest().empty()) {
    if (fields.number<std::uint32_t>() != kMemberMark) break;
    fields.bytes(4);  // versions
    ZipMember member;
    const bool encrypted = (fields.number<std::uint16_t>() & 1U) != 0;
    member.method = fields.number<std::uint16_t>();
    fields.bytes(8);  // time, checksum
    member.packed = fields.number<std::uint32_t>();
    member.bytes = fields.number<std::uint32_t>();
    const auto name = fields.number<std::uint16_t>();
    const auto extra = fields.number<std::uint16_t>();
    const auto comment = fields.number<std::uint16_t>();
    fields.bytes(8);  // disk, attributes
    member.header = fields.number<std::uint32_t>();
    member.name = fields.bytes(name);
    widen(fields.bytes(extra), member);
    fields.bytes(comment);
    if (!fields.ok()) return damaged_zip(file);
    if (encrypted)
      return fail(fmt::format("{}: {} is encrypted; unpack it", file.name(), member.name));
    out.push_back(std::move(member));
  }
  if (out.empty()) return damaged_zip(file);
  return out;
}

Result<std::unique_ptr<ByteStream>> open_member(const File& file, const ZipMember& member) {
  const Result<std::string> local = zip_bytes(file, member.header, 30);
  if (!local) return tl::make_unexpected(local.error());
  Fields fields(*local);
  if (fields.number<std::uint32_t>() != kLocalMark) return damaged_zip(file);
  fields.bytes(22);
  const std::uint64_t name = fields.number<std::uint16_t>();
  const std::uint64_t extra = fields.number<std::uint16_t>();
  const std::uint64_t begin = member.header + 30 + name + extra;
  if (begin > file.size() || member.packed > file.size() - begin) return damaged_zip(file);
  auto packed = std::make_unique<FileStream>(file, begin, member.packed);
  if (member.method == 0) return std::unique_ptr<ByteStream>(std::move(packed));
  if (member.method != 8) {
    return fail(fmt::format("{}: {} is packed with method {}; save it with numpy.savez_compressed",
                            file.name(), member.name, member.method));
  }
  auto out = unpacking(Packing::kDeflate, std::move(packed), file.name());
  if (!out) return fail(fmt::format("{}: needs more memory than available", file.name()));
  return out;
}

}  // namespace imunoise::recording
