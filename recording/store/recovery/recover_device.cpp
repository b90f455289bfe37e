#include <fmt/core.h>

#include <algorithm>
#include <map>

#include "core/support/counted.h"
#include "recording/store/format/layout.h"
#include "recording/store/recovery/recover.h"
#include "recording/store/recovery/seal.h"

namespace imunoise::recording {
namespace {

// Recovers one folder: first its chunks, then, number by number, the segments between them.
class DeviceRecovery {
 public:
  DeviceRecovery(FileSystem& files, const DeviceFolder& where, const v1::Manifest& known,
                 Recovery how)
      : files_(files), where_(where), known_(known), how_(how), expected_(checksums(known)) {
    for (const v1::ChunkEntry& chunk : known.chunks()) {
      const std::size_t slash = chunk.file().rfind('/');
      if (chunk.file().substr(0, slash) != where.folder) continue;
      listed_[number_of(chunk.file().substr(slash + 1), kChunkSuffix).value_or(0)] = chunk;
      out_.promised += chunk.samples();
    }
  }

  Result<RecoveredDevice> run() {
    const auto names = list_device_files(files_, where_);
    if (!names) return tl::make_unexpected(names.error());
    for (const std::string& name : names->unfinished) {
      if (auto done = files_.remove(where_.path() / name); !done)
        return tl::make_unexpected(done.error());
    }
    for (const std::uint64_t number : names->chunks) {
      if (auto done = keep_chunk(number); !done) return tl::make_unexpected(done.error());
    }
    for (const std::uint64_t number : names->journals) {
      if (auto done = seal(number); !done) return tl::make_unexpected(done.error());
    }
    for (const std::string& name : names->broken) record_broken(name);
    for (const auto& [number, chunk] : listed_) record_missing(number, chunk);
    for (auto& [number, chunk] : chunks_) out_.chunks.push_back(std::move(chunk));
    out_.next.segment = names->next_number;
    out_.next.sequence = blocks_before(kNoBlock) + 1;
    out_.next.replicate = where_.replicate();
    return std::move(out_);
  }

 private:
  Result<void> keep_chunk(std::uint64_t number) {
    auto read = read_chunk(files_, where_, number, expected_);
    if (read) {
      add(number, std::move(read->entry), read->chunk);
      return {};
    }
    const std::string& why = read.error().message;
    const std::string name = numbered(number, kChunkSuffix);
    switch (read.error().kind) {
      case ChunkTrouble::Kind::kUnread:
        return fail(why);
      case ChunkTrouble::Kind::kUnusable:
        out_.settled = false;
        out_.repaired.push_back(why + "; imunoise leaves it unchanged");
        if (const auto known = listed_.find(number); known != listed_.end()) {
          chunks_[number] = known->second;
          out_.unproven += known->second.samples();
        }
        return {};
      case ChunkTrouble::Kind::kDamaged:
        break;
    }
    const auto aside = set_aside(files_, where_.path(), name);
    if (!aside) return tl::make_unexpected(aside.error());
    record(damaged_file(name, *aside, why));
    return {};
  }

  Result<void> seal(std::uint64_t number) {
    const std::string name = numbered(number, kJournalSuffix);
    const std::optional<v1::JournalHeader> header = known_header();
    auto sealed = seal_segment(files_, where_, number, blocks_before(number),
                               header ? &*header : nullptr, blocks_after(number));
    if (!sealed) return tl::make_unexpected(sealed.error());
    if (sealed->damage) record(damaged_segment(where_, number, *sealed));
    if (!sealed->entry) return {};
    out_.repaired.push_back(fmt::format("{}: moved {} to chunk {}", where_.file(name),
                                        counted(sealed->entry->samples(), "sample"),
                                        sealed->entry->file()));
    add(number, std::move(*sealed->entry), *sealed->chunk);
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

  // The last block in chunks up to this number.
  std::uint64_t blocks_before(std::uint64_t number) const {
    std::uint64_t out = 0;
    for (auto chunk = chunks_.begin(); chunk != chunks_.upper_bound(number); ++chunk)
      out = std::max(out, std::uint64_t{chunk->second.last_sequence()});
    return out;
  }

  // The first block in chunks beyond this number: a segment of which only the removal failed holds
  // blocks that were written again.
  std::uint64_t blocks_after(std::uint64_t number) const {
    const auto next = chunks_.upper_bound(number);
    return next == chunks_.end() ? kNoBlock : std::uint64_t{next->second.first_sequence()};
  }

  void add(std::uint64_t number, v1::ChunkEntry entry, const Chunk& chunk) {
    chunks_[number] = std::move(entry);
    if (!out_.device) {
      out_.device = chunk.device;
      out_.rows.assign(chunk.streams.size(), 0);
    }
    for (std::size_t i = 0; i < std::min(out_.rows.size(), chunk.streams.size()); ++i)
      out_.rows[i] += chunk.streams[i].size();
  }

  // `aside` is empty for a file that is missing.
  v1::DamagedFile damaged_file(const std::string& name, const std::string& aside,
                               const std::string& why) const {
    v1::DamagedFile out;
    out.set_file(where_.file(name));
    if (!aside.empty()) out.set_kept_as(where_.file(aside));
    out.set_reason(why);
    const auto listed = listed_.find(number_of(name, kChunkSuffix).value_or(0));
    if (listed != listed_.end()) out.set_samples(listed->second.samples());
    return out;
  }

  void record(v1::DamagedFile damaged) {
    out_.repaired.push_back(damaged.kept_as().empty()
                                ? damaged.reason()
                                : fmt::format("{}: set aside as {}: {}", damaged.file(),
                                              damaged.kept_as(), damaged.reason()));
    out_.damaged.push_back(std::move(damaged));
  }

  bool on_record(const std::string& file, const std::string& kept_as) const {
    const auto same = [&](const v1::DamagedFile& one) {
      return one.file() == file && (one.kept_as() == kept_as || kept_as.empty());
    };
    return std::any_of(known_.damaged().begin(), known_.damaged().end(), same) ||
           std::any_of(out_.damaged.begin(), out_.damaged.end(), same);
  }

  void record_broken(const std::string& name) {
    const std::string before(name_before(name));
    if (!on_record(where_.file(before), where_.file(name)))
      record(damaged_file(before, name, "was damaged and set aside before"));
  }

  // A chunk that the manifest lists stays listed until its loss is accepted.
  void record_missing(std::uint64_t number, const v1::ChunkEntry& chunk) {
    if (chunks_.contains(number) || on_record(chunk.file(), "")) return;
    const std::string why =
        fmt::format("{}: is missing, with {}", chunk.file(), counted(chunk.samples(), "sample"));
    if (how_ == Recovery::kEverything)
      return record(damaged_file(numbered(number, kChunkSuffix), "", why));
    chunks_[number] = chunk;
    out_.settled = false;
    out_.unproven += chunk.samples();
    out_.repaired.push_back(why + "; put it back");
  }

  FileSystem& files_;
  const DeviceFolder& where_;
  const v1::Manifest& known_;
  Recovery how_;
  Checksums expected_;
  std::map<std::uint64_t, v1::ChunkEntry> listed_;  // in the manifest, of this folder
  std::map<std::uint64_t, v1::ChunkEntry> chunks_;  // found
  RecoveredDevice out_;
};

}  // namespace

Result<RecoveredDevice> recover_device(FileSystem& files, const DeviceFolder& where,
                                       const v1::Manifest& known, Recovery how) {
  return DeviceRecovery(files, where, known, how).run();
}

}  // namespace imunoise::recording
