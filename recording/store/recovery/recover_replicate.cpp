#include <fmt/core.h>

#include <algorithm>
#include <utility>

#include "recording/store/format/layout.h"
#include "recording/store/recovery/recover.h"

namespace imunoise::recording {
namespace {

// Recovers the folders of one replicate.
class ReplicateRecovery {
 public:
  ReplicateRecovery(FileSystem& files, const std::filesystem::path& root, std::uint32_t replicate,
                    v1::Manifest known, Recovery how)
      : files_(files), root_(root), replicate_(replicate), known_(std::move(known)), how_(how) {}

  Result<RecoveredReplicate> run(const v1::ReplicateManifest& known,
                                 const std::string& unfinished) {
    out_.manifest = known;
    out_.manifest.clear_chunks();
    if (known.has_note()) end_open_replicate(*out_.manifest.mutable_note(), unfinished);
    const auto folders = find_device_folders(files_, root_, replicate_);
    if (!folders) return tl::make_unexpected(folders.error());
    for (const DeviceFolder& where : *folders) {
      const auto device = recover_device(files_, where, known_, how_);
      if (!device) return tl::make_unexpected(device.error());
      take(where, *device);
    }
    for (const std::string& folder : promised_folders(known_)) {
      const bool there = std::any_of(folders->begin(), folders->end(),
                                     [&](const auto& one) { return one.folder == folder; });
      if (!there) take({root_, folder}, missing_device({root_, folder}));
    }
    sort_chunks(out_.manifest);
    if (known.has_note()) out_.manifest.mutable_note()->set_settled(out_.settled);
    if (how_ == Recovery::kEverything) {
      for (v1::DamagedFile& one : *out_.manifest.mutable_damaged()) one.set_accepted(true);
    }
    return std::move(out_);
  }

 private:
  // Of a folder that is not there.
  RecoveredDevice missing_device(const DeviceFolder& where) const {
    RecoveredDevice out;
    const bool accepted = how_ == Recovery::kEverything;
    out.settled = accepted;
    out.repaired.push_back(where.folder + ": is missing, with all its samples; put it back");
    for (const v1::ChunkEntry& chunk : known_.chunks()) {
      if (!chunk.file().starts_with(where.folder + "/")) continue;
      out.promised += chunk.samples();
      if (!accepted) {
        out.unproven += chunk.samples();
        out.chunks.push_back(chunk);
        continue;
      }
      v1::DamagedFile& damaged = out.damaged.emplace_back();
      damaged.set_file(chunk.file());
      damaged.set_samples(chunk.samples());
      damaged.set_reason(chunk.file() + ": is missing");
    }
    return out;
  }

  void take(const DeviceFolder& where, const RecoveredDevice& device) {
    if (device.device) out_.devices.push_back(*device.device);
    out_.manifest.mutable_chunks()->Add(device.chunks.begin(), device.chunks.end());
    for (const v1::DamagedFile& one : device.damaged)
      set_damaged(*out_.manifest.mutable_damaged(), one);
    out_.repaired.insert(out_.repaired.end(), device.repaired.begin(), device.repaired.end());
    out_.settled = out_.settled && device.settled;
    if (out_.manifest.has_note()) account(where.device(), device, *out_.manifest.mutable_note());
  }

  // Compares a device's rows with those that the manifest promised.
  void account(const std::string& name, const RecoveredDevice& device, v1::ReplicateNote& note) {
    const bool accepts = how_ == Recovery::kEverything && device.unproven == 0;
    std::uint64_t promised = 0;
    for (v1::StreamCount& count : *note.mutable_streams()) {
      if (count.device() != name) continue;
      promised += count.stored() - std::min(count.stored(), count.missing());
      const std::uint64_t rows = rows_of(device, count.stream());
      if (accepts && rows + count.missing() < count.stored())
        count.set_missing(count.stored() - rows);
    }
    promised = std::max(promised, device.promised);
    std::uint64_t found = device.unproven;
    for (const std::uint64_t rows : device.rows) found += rows;
    if (found >= promised || note.state() != v1::complete) return;
    note.set_state(v1::interrupted);
    note.set_reason(fmt::format(
        "device {}: {} of {} stored samples are missing{}", name, promised - found, promised,
        device.damaged.empty() ? "" : ": " + device.damaged.front().reason()));
  }

  static std::uint64_t rows_of(const RecoveredDevice& device, const std::string& stream) {
    for (int i = 0; device.device && i < device.device->streams_size(); ++i) {
      if (device.device->streams(i).name() == stream)
        return device.rows[static_cast<std::size_t>(i)];
    }
    return 0;
  }

  FileSystem& files_;
  const std::filesystem::path& root_;
  std::uint32_t replicate_;
  v1::Manifest known_;  // of this replicate alone
  Recovery how_;
  RecoveredReplicate out_;
};

}  // namespace

Result<RecoveredReplicate> recover_replicate(FileSystem& files, const std::filesystem::path& root,
                                             std::uint32_t replicate,
                                             const v1::RecordingManifest& recording,
                                             const v1::ReplicateManifest& known, Recovery how,
                                             const std::string& unfinished) {
  return ReplicateRecovery(files, root, replicate, whole_manifest(recording, known), how)
      .run(known, unfinished);
}

}  // namespace imunoise::recording
