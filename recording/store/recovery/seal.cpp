#include "recording/store/recovery/seal.h"

#include <fmt/core.h>

#include <algorithm>

#include "recording/store/format/crc32c.h"
#include "recording/store/format/layout.h"
#include "recording/store/manifest/device_folder.h"

namespace imunoise::recording {
namespace {

std::optional<std::string> describe_damage(const Segment& segment) {
  if (segment.damage.empty() && segment.unusable == 0) return std::nullopt;
  std::string out;
  for (const Damage& one : segment.damage) {
    out +=
        fmt::format("{}{} bytes at byte {} are not a complete block{}", out.empty() ? "" : "; ",
                    one.bytes, one.offset, one.at_end ? " (an interrupted write or damage)" : "");
    if (out.size() > 400) break;
  }
  if (segment.unusable > 0) {
    out += fmt::format("{}{} blocks are not of this device", out.empty() ? "" : "; ",
                       segment.unusable);
  }
  if (segment.lost_blocks > 0) out += fmt::format("; {} blocks are lost", segment.lost_blocks);
  return out;
}

bool is_torn(const Segment& segment) {
  return segment.unusable == 0 && segment.lost_blocks == 0 && segment.damage.size() == 1 &&
         segment.damage.front().at_end;
}

// When an earlier attempt removed the segment, or set it aside, and only then failed: the chunk
// that it left. `error` is that of reading the segment.
Result<Sealed> sealed_before(FileSystem& files, const DeviceFolder& where, std::uint64_t number,
                             const v1::JournalHeader* fallback, const Error& error) {
  const auto names = list_device_files(files, where);
  if (!names || std::binary_search(names->journals.begin(), names->journals.end(), number)) {
    return tl::make_unexpected(error);
  }
  if (auto done = files.sync_folder(where.path()); !done) return tl::make_unexpected(done.error());
  Sealed out;
  const std::string journal = numbered(number, kJournalSuffix);
  for (const std::string& name : names->broken) {
    if (name_before(name) != journal) continue;
    const auto bytes = files.read(where.path() / name);
    if (!bytes) return tl::make_unexpected(bytes.error());
    const Result<Segment> segment = read_segment(*bytes, 0, fallback);
    if (!segment) return tl::make_unexpected(segment.error());
    out.damage = describe_damage(*segment);
    out.torn = is_torn(*segment);
    out.kept_as = name;
  }
  if (!std::binary_search(names->chunks.begin(), names->chunks.end(), number)) return out;
  auto chunk = read_chunk(files, where, number, {});
  if (!chunk) return fail(chunk.error().message);
  out.entry = std::move(chunk->entry);
  out.chunk = std::move(chunk->chunk);
  return out;
}

}  // namespace

v1::DamagedFile damaged_segment(const DeviceFolder& where, std::uint64_t number,
                                const Sealed& sealed) {
  v1::DamagedFile out;
  out.set_file(where.file(numbered(number, kJournalSuffix)));
  out.set_kept_as(where.file(sealed.kept_as));
  out.set_reason(*sealed.damage + "; its whole blocks are kept");
  // An interrupted write, which costs nothing, looks like a damaged end.
  out.set_accepted(sealed.torn);
  return out;
}

Result<Sealed> seal_segment(FileSystem& files, const DeviceFolder& where, std::uint64_t number,
                            std::uint64_t after, const v1::JournalHeader* fallback,
                            std::uint64_t before) {
  const std::string journal = numbered(number, kJournalSuffix);
  const auto trouble = [&](const Error& error) {
    return fail(fmt::format("{}: {}", where.file(journal), error.message));
  };
  const auto bytes = files.read(where.path() / journal);
  if (!bytes) return sealed_before(files, where, number, fallback, bytes.error());
  Result<Segment> segment = read_segment(*bytes, after, fallback, before);
  if (!segment) return trouble(segment.error());
  Sealed out;
  out.damage = describe_damage(*segment);
  out.torn = is_torn(*segment);
  if (segment->chunk) {
    const auto image = encode_chunk(*segment->chunk);
    if (!image) return trouble(image.error());
    const std::string name = numbered(number, kChunkSuffix);
    const auto holds_it = [&](std::string_view back) -> Result<void> {
      const auto chunk = decode_chunk(back);
      if (!chunk) return trouble({"its chunk cannot be read back: " + chunk.error().message});
      if (same_samples(*chunk, *segment->chunk)) return {};
      return trouble({"its chunk holds other samples; check the disk and the memory"});
    };
    if (auto done = replace_file(files, where.path() / name, *image, holds_it); !done) {
      return tl::make_unexpected(done.error());
    }
    out.entry = chunk_entry(where.file(name), *segment->chunk, *image);
    out.chunk = std::move(segment->chunk);
  }
  if (out.damage) {
    const auto aside = set_aside(files, where.path(), journal);
    if (!aside) return tl::make_unexpected(aside.error());
    out.kept_as = *aside;
    return out;
  }
  if (auto done = files.remove(where.path() / journal); !done) {
    return tl::make_unexpected(done.error());
  }
  if (auto done = files.sync_folder(where.path()); !done) {
    return tl::make_unexpected(done.error());
  }
  return out;
}

}  // namespace imunoise::recording
