#include "recording/store/manifest/device_folder.h"

#include <fmt/core.h>

#include <algorithm>
#include <set>

#include "recording/store/format/crc32c.h"
#include "recording/store/format/layout.h"

namespace imunoise::recording {
namespace {

// The number that a file of ours begins with, whatever follows: "000012.h5.broken-2" has 12.
std::uint64_t leading_number(const std::string& name) {
  const std::string digits = name.substr(0, name.find('.'));
  return number_of(digits, "").value_or(0);
}

Result<void> add_device_folders(const FileSystem& files, const std::filesystem::path& root,
                                std::uint32_t replicate, std::vector<DeviceFolder>& to) {
  const std::string folder = replicate_folder(replicate);
  const auto devices = files.list(root / folder);
  if (!devices) return tl::make_unexpected(devices.error());
  for (const std::string& device : *devices) {
    if (device.ends_with('/'))
      to.push_back({root, folder + "/" + device.substr(0, device.size() - 1)});
  }
  return {};
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

Result<DeviceFolder> make_device_folder(FileSystem& files, const std::filesystem::path& root,
                                        std::uint32_t replicate, const std::string& device) {
  const std::string parent = replicate_folder(replicate);
  DeviceFolder out{root, parent + "/" + device};
  if (auto done = files.make_folder(root / parent); !done) return tl::make_unexpected(done.error());
  if (auto done = files.sync_folder(root); !done) return tl::make_unexpected(done.error());
  if (auto done = files.make_folder(out.path()); !done) return tl::make_unexpected(done.error());
  if (auto done = files.sync_folder(root / parent); !done) {
    return tl::make_unexpected(done.error());
  }
  const auto names = files.list(out.path());
  if (!names) return tl::make_unexpected(names.error());
  if (names->empty()) return out;
  return fail(
      fmt::format("{}: is recorded already; record another replicate, or into another folder",
                  out.path().string()));
}

Result<std::vector<DeviceFolder>> find_device_folders(const FileSystem& files,
                                                      const std::filesystem::path& root) {
  const auto names = files.list(root);
  if (!names) return tl::make_unexpected(names.error());
  std::set<std::uint32_t> replicates;
  for (const std::string& name : *names) {
    if (!name.ends_with('/')) continue;
    if (const auto number = replicate_of(name.substr(0, name.size() - 1)))
      replicates.insert(*number);
  }
  std::vector<DeviceFolder> out;
  for (const std::uint32_t replicate : replicates) {
    if (auto done = add_device_folders(files, root, replicate, out); !done)
      return tl::make_unexpected(done.error());
  }
  return out;
}

Result<std::vector<DeviceFolder>> find_device_folders(const FileSystem& files,
                                                      const std::filesystem::path& root,
                                                      std::uint32_t replicate) {
  std::vector<DeviceFolder> out;
  const auto there = files.exists(root / replicate_folder(replicate));
  if (!there) return tl::make_unexpected(there.error());
  if (!*there) return out;
  if (auto done = add_device_folders(files, root, replicate, out); !done)
    return tl::make_unexpected(done.error());
  return out;
}

Result<DeviceFiles> list_device_files(const FileSystem& files, const DeviceFolder& where) {
  const auto names = files.list(where.path());
  if (!names) return tl::make_unexpected(names.error());
  DeviceFiles out;
  for (const std::string& name : *names) {
    if (const auto number = number_of(name, kChunkSuffix)) out.chunks.push_back(*number);
    if (const auto number = number_of(name, kJournalSuffix)) out.journals.push_back(*number);
    if (name.ends_with(kPartSuffix)) out.unfinished.push_back(name);
    if (is_broken(name)) out.broken.push_back(name);
    out.next_number = std::max(out.next_number, leading_number(name) + 1);
  }
  std::sort(out.chunks.begin(), out.chunks.end());
  std::sort(out.journals.begin(), out.journals.end());
  return out;
}

tl::expected<ReadChunk, ChunkTrouble> read_chunk(const FileSystem& files, const DeviceFolder& where,
                                                 std::uint64_t number, const Checksums& expected) {
  using Kind = ChunkTrouble::Kind;
  const std::string name = numbered(number, kChunkSuffix);
  const auto trouble = [&](Kind kind, const std::string& what) {
    return tl::make_unexpected(
        ChunkTrouble{kind, fmt::format("{}: chunk {}: {}", where.folder, name, what)});
  };
  const auto bytes = files.read(where.path() / name);
  if (!bytes) return trouble(Kind::kUnread, bytes.error().message);
  const auto listed = expected.find(where.file(name));
  const bool as_written = listed != expected.end() && listed->second == crc32c_text(*bytes);
  Result<Chunk> chunk = decode_chunk(*bytes);
  if (!chunk) {
    const bool whole = as_written || chunk_of_other_version(*bytes);
    return trouble(whole ? Kind::kUnusable : Kind::kDamaged, chunk.error().message);
  }
  const std::string belongs = replicate_folder(chunk->replicate) + "/" + chunk->device.name();
  if (belongs != where.folder)
    return trouble(Kind::kUnusable, "belongs into " + belongs + ": move it back");
  v1::ChunkEntry entry = chunk_entry(where.file(name), *chunk, *bytes);
  if (listed != expected.end() && !as_written) {
    return trouble(Kind::kDamaged,
                   fmt::format("was changed since it was written: checksum {} where the manifest "
                               "has {}",
                               entry.crc32c(), listed->second));
  }
  return ReadChunk{std::move(*chunk), std::move(entry)};
}

std::string keep_the_rest(std::size_t intact) {
  return fmt::format("; the {} chunks before it are intact (imunoise verify --repair keeps them)",
                     intact);
}

}  // namespace imunoise::recording
