#include "recording/store/seal.h"

#include <fmt/core.h>

#include <algorithm>

#include "recording/store/crc32c.h"
#include "recording/store/journal_reader.h"
#include "recording/store/layout.h"

namespace imunoise::recording {
namespace {

std::optional<std::string> describe_damage(const Segment& segment) {
  if (segment.damage.empty() && segment.unusable == 0) return std::nullopt;
  std::string out;
  for (const Damage& one : segment.damage) {
    out +=
        fmt::format("{}{} bytes at byte {} are no whole block{}", out.empty() ? "" : "; ",
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

}  // namespace

std::uint32_t DeviceFolder::replicate() const {
  return replicate_of(folder.substr(0, folder.find('/'))).value_or(0);
}

std::string DeviceFolder::device() const { return folder.substr(folder.find('/') + 1); }

v1::ChunkEntry chunk_entry(const std::string& file, const Chunk& chunk, std::string_view bytes) {
  v1::ChunkEntry out;
  out.set_file(file);
  out.set_bytes(bytes.size());
  out.set_crc32c(crc32c_text(bytes));
  out.set_first_sequence(chunk.first_sequence);
  out.set_last_sequence(chunk.last_sequence);
  out.set_samples(row_count(chunk));
  return out;
}

Result<std::string> set_aside(FileSystem& files, const std::filesystem::path& folder,
                              const std::string& name) {
  const auto names = files.list(folder);
  if (!names) return tl::make_unexpected(names.error());
  std::string aside = name + std::string(kBrokenSuffix);
  for (int i = 2; std::find(names->begin(), names->end(), aside) != names->end(); ++i) {
    aside = fmt::format("{}{}-{}", name, kBrokenSuffix, i);
  }
  if (auto done = files.rename(folder / name, folder / aside); !done) {
    return tl::make_unexpected(done.error());
  }
  if (auto done = files.sync_folder(folder); !done) return tl::make_unexpected(done.error());
  return aside;
}

Result<Sealed> seal_segment(FileSystem& files, const DeviceFolder& where, std::uint64_t number,
                            std::uint64_t after, const v1::JournalHeader* fallback) {
  const std::string journal = numbered(number, kJournalSuffix);
  const auto trouble = [&](const Error& error) {
    return fail(fmt::format("{}: {}", where.file(journal), error.message));
  };
  const auto bytes = files.read(where.path() / journal);
  if (!bytes) return tl::make_unexpected(bytes.error());
  const Result<Segment> segment = read_segment(*bytes, after, fallback);
  if (!segment) return trouble(segment.error());
  Sealed out;
  out.damage = describe_damage(*segment);
  if (segment->chunk) {
    const std::string name = numbered(number, kChunkSuffix);
    const auto image = encode_chunk(*segment->chunk);
    if (!image) return trouble(image.error());
    if (auto good = reopen_chunk(*image); !good) {
      return trouble({"its chunk cannot be opened: " + good.error().message});
    }
    if (auto done = replace_file(files, where.path() / name, *image); !done) {
      return tl::make_unexpected(done.error());
    }
    out.entry = chunk_entry(where.file(name), *segment->chunk, *image);
  }
  if (out.damage) {
    const auto aside = set_aside(files, where.path(), journal);
    if (!aside) return tl::make_unexpected(aside.error());
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
