#include "recording/store/recover.h"

#include <fmt/core.h>

#include <algorithm>
#include <set>

#include "recording/store/format_version.h"
#include "recording/store/layout.h"

namespace imunoise::recording {
namespace {

// Recovers one folder, number by number: a chunk of a number comes before its segment.
class DeviceRecovery {
 public:
  DeviceRecovery(FileSystem& files, const DeviceFolder& where, const v1::Manifest& known)
      : files_(files), where_(where), known_(known), expected_(checksums(known)) {}

  Result<RecoveredDevice> run() {
    const auto names = list_device_files(files_, where_);
    if (!names) return tl::make_unexpected(names.error());
    for (const std::string& name : names->unfinished) {
      if (auto done = files_.remove(where_.path() / name); !done) {
        return tl::make_unexpected(done.error());
      }
    }
    std::set<std::uint64_t> numbers(names->chunks.begin(), names->chunks.end());
    numbers.insert(names->journals.begin(), names->journals.end());
    const auto has = [](const std::vector<std::uint64_t>& list, std::uint64_t number) {
      return std::binary_search(list.begin(), list.end(), number);
    };
    for (const std::uint64_t number : numbers) {
      if (has(names->chunks, number)) {
        if (auto done = keep_chunk(number); !done) return tl::make_unexpected(done.error());
      }
      if (has(names->journals, number)) {
        if (auto done = seal(number); !done) return tl::make_unexpected(done.error());
      }
    }
    out_.next.segment = names->next_number;
    out_.next.sequence = after_ + 1;
    out_.next.replicate = where_.replicate();
    return std::move(out_);
  }

 private:
  Result<void> keep_chunk(std::uint64_t number) {
    auto read = read_chunk(files_, where_, number, expected_);
    if (!read) {
      const auto aside = set_aside(files_, where_.path(), numbered(number, kChunkSuffix));
      if (!aside) return tl::make_unexpected(aside.error());
      out_.repaired.push_back(fmt::format("{}: set aside as {}", read.error().message, *aside));
      return {};
    }
    add(std::move(read->entry), read->chunk.device);
    return {};
  }

  Result<void> seal(std::uint64_t number) {
    const std::string name = numbered(number, kJournalSuffix);
    const std::optional<v1::JournalHeader> header = known_header();
    const auto sealed = seal_segment(files_, where_, number, after_, header ? &*header : nullptr);
    if (!sealed) return tl::make_unexpected(sealed.error());
    if (sealed->damage) {
      out_.repaired.push_back(
          fmt::format("{}: {}; the segment is set aside, its whole blocks are kept",
                      where_.file(name), *sealed->damage));
    }
    if (!sealed->entry) return {};
    out_.repaired.push_back(fmt::format("{}: its {} samples are in chunk {} now", where_.file(name),
                                        sealed->entry->samples(), sealed->entry->file()));
    auto read = read_chunk(files_, where_, number, {});
    if (!read) return tl::make_unexpected(read.error());
    add(*sealed->entry, read->chunk.device);
    return {};
  }

  // What a segment's header says, from its neighbours or the manifest.
  std::optional<v1::JournalHeader> known_header() const {
    const auto& listed = known_.devices();
    const auto mine =
        std::find_if(listed.begin(), listed.end(),
                     [&](const v1::RecordedDevice& one) { return one.name() == where_.device(); });
    if (!out_.device && mine == listed.end()) return std::nullopt;
    v1::JournalHeader out;
    *out.mutable_device() = out_.device ? *out_.device : *mine;
    out.set_replicate(where_.replicate());
    return out;
  }

  void add(v1::ChunkEntry entry, const v1::RecordedDevice& device) {
    after_ = std::max(after_, std::uint64_t{entry.last_sequence()});
    out_.chunks.push_back(std::move(entry));
    if (!out_.device) out_.device = device;
  }

  FileSystem& files_;
  const DeviceFolder& where_;
  const v1::Manifest& known_;
  Checksums expected_;
  std::uint64_t after_ = 0;  // the last block that is in a chunk
  RecoveredDevice out_;
};

}  // namespace

Result<RecoveredDevice> recover_device(FileSystem& files, const DeviceFolder& where,
                                       const v1::Manifest& known) {
  return DeviceRecovery(files, where, known).run();
}

Result<RecoveredRecording> recover_recording(FileSystem& files, const std::filesystem::path& root) {
  RecoveredRecording out;
  auto manifest = read_manifest(files, root);
  if (!manifest) {
    if (of_other_version(files, root)) return tl::make_unexpected(manifest.error());
    const auto aside = set_aside(files, root, std::string(kManifestName));
    if (!aside) return tl::make_unexpected(manifest.error());
    out.repaired.push_back(fmt::format("{}: set aside as {}", manifest.error().message, *aside));
  }
  const std::optional<v1::Manifest> before = manifest ? *manifest : std::nullopt;
  if (before) out.manifest = *before;
  out.manifest.set_version(kFormatVersion);
  out.manifest.clear_chunks();
  const auto folders = find_device_folders(files, root);
  if (!folders) return tl::make_unexpected(folders.error());
  for (const DeviceFolder& where : *folders) {
    const auto device = recover_device(files, where, before.value_or(v1::Manifest()));
    if (!device) return tl::make_unexpected(device.error());
    if (device->device) add_device(out.manifest, *device->device);
    for (const v1::ChunkEntry& chunk : device->chunks) *out.manifest.add_chunks() = chunk;
    out.repaired.insert(out.repaired.end(), device->repaired.begin(), device->repaired.end());
  }
  out.manifest.set_closed(true);
  if (!before || print_manifest(*before) != print_manifest(out.manifest)) {
    if (auto done = write_manifest(files, root, out.manifest); !done) {
      return tl::make_unexpected(done.error());
    }
    out.repaired.push_back(fmt::format("{}: {}", (root / kManifestName).string(),
                                       before ? "brought up to date" : "made from the chunks"));
  }
  return out;
}

}  // namespace imunoise::recording
