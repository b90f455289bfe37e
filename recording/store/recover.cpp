#include "recording/store/recover.h"

#include <fmt/core.h>
#include <google/protobuf/util/message_differencer.h>

#include <algorithm>
#include <set>

#include "recording/store/format_version.h"
#include "recording/store/layout.h"

namespace imunoise::recording {
namespace {

// Recovers a recording, whose manifest may be lost.
class RecordingRecovery {
 public:
  RecordingRecovery(FileSystem& files, const std::filesystem::path& root, Recovery how)
      : files_(files), root_(root), how_(how) {}

  Result<RecoveredRecording> run() {
    if (auto done = take_manifest(); !done) return tl::make_unexpected(done.error());
    out_.manifest = before_.value_or(v1::Manifest());
    out_.manifest.set_version(kFormatVersion);
    out_.manifest.clear_chunks();
    for (const v1::DamagedFile& one : damaged_) set_damaged(out_.manifest, one);
    if (auto done = recover_folders(); !done) return tl::make_unexpected(done.error());
    accept_damage();
    sort_chunks(out_.manifest);
    out_.manifest.set_closed(true);
    using google::protobuf::util::MessageDifferencer;
    if (before_ && MessageDifferencer::Equals(*before_, out_.manifest)) return std::move(out_);
    if (auto done = write_manifest(files_, root_, out_.manifest); !done)
      return tl::make_unexpected(done.error());
    out_.repaired.push_back(fmt::format("{}: {}", (root_ / kManifestName).string(),
                                        before_ ? "brought up to date" : "made from the chunks"));
    return std::move(out_);
  }

 private:
  // Reads the manifest; a damaged one is set aside.
  Result<void> take_manifest() {
    const auto text = read_manifest_text(files_, root_);
    if (!text) return tl::make_unexpected(text.error());
    if (!*text) return {};
    auto manifest = parse_manifest((root_ / kManifestName).string(), **text);
    if (manifest) {
      before_ = std::move(*manifest);
      return {};
    }
    if (of_other_version(**text)) return tl::make_unexpected(manifest.error());
    const auto aside = set_aside(files_, root_, std::string(kManifestName));
    if (!aside) return tl::make_unexpected(aside.error());
    out_.repaired.push_back(fmt::format("{}: set aside as {}", manifest.error().message, *aside));
    v1::DamagedFile& damaged = damaged_.emplace_back();
    damaged.set_file(std::string(kManifestName));
    damaged.set_kept_as(*aside);
    damaged.set_reason(manifest.error().message);
    return {};
  }

  // Replicates whose every row is in a listed chunk; what became of them later is for `verify`.
  std::set<std::uint32_t> settled() const {
    std::set<std::uint32_t> out;
    if (!before_ || how_ == Recovery::kEverything) return out;
    for (const v1::ReplicateNote& note : before_->replicates()) {
      if (note.settled() && note.state() != v1::open) out.insert(note.replicate());
    }
    return out;
  }

  Result<void> recover_folders() {
    const std::set<std::uint32_t> left_out = settled();
    const v1::Manifest known = before_.value_or(v1::Manifest());
    for (const v1::ChunkEntry& chunk : known.chunks()) {
      const auto replicate = replicate_of(chunk.file().substr(0, chunk.file().find('/')));
      if (left_out.contains(replicate.value_or(0))) *out_.manifest.add_chunks() = chunk;
    }
    auto folders = find_device_folders(files_, root_, left_out);
    if (!folders) return tl::make_unexpected(folders.error());
    for (const DeviceFolder& where : *folders) {
      const auto device = recover_device(files_, where, known, how_);
      if (!device) return tl::make_unexpected(device.error());
      take(where, *device);
    }
    for (const std::string& folder : promised_folders(known)) {
      const DeviceFolder where{root_, folder};
      const bool there = std::any_of(folders->begin(), folders->end(),
                                     [&](const auto& one) { return one.folder == folder; });
      if (!there && !left_out.contains(where.replicate()))
        take(where, missing_device(known, where));
    }
    for (v1::ReplicateNote& note : *out_.manifest.mutable_replicates()) {
      if (!left_out.contains(note.replicate()))
        note.set_settled(!unsettled_.contains(note.replicate()));
    }
    return {};
  }

  // Of a folder that is not there.
  RecoveredDevice missing_device(const v1::Manifest& known, const DeviceFolder& where) const {
    RecoveredDevice out;
    out.settled = how_ == Recovery::kEverything;
    out.repaired.push_back(where.folder + ": is missing, with all its samples; put it back");
    for (const v1::ChunkEntry& chunk : known.chunks()) {
      if (!chunk.file().starts_with(where.folder + "/")) continue;
      out.promised += chunk.samples();
      if (how_ == Recovery::kUnsettled) {
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
    if (device.device) add_device(out_.manifest, *device.device);
    for (const v1::ChunkEntry& chunk : device.chunks) *out_.manifest.add_chunks() = chunk;
    for (const v1::DamagedFile& one : device.damaged) set_damaged(out_.manifest, one);
    out_.repaired.insert(out_.repaired.end(), device.repaired.begin(), device.repaired.end());
    if (!device.settled) unsettled_.insert(where.replicate());
    for (v1::ReplicateNote& note : *out_.manifest.mutable_replicates()) {
      if (note.replicate() == where.replicate()) account(where.device(), device, note);
    }
  }

  // Compares a device's rows with those that the manifest promised.
  void account(const std::string& name, const RecoveredDevice& device, v1::ReplicateNote& note) {
    std::uint64_t promised = 0;
    for (v1::StreamCount& count : *note.mutable_streams()) {
      if (count.device() != name) continue;
      promised += count.stored() - std::min(count.stored(), count.missing());
      const std::uint64_t rows = rows_of(device, count.stream());
      if (how_ == Recovery::kEverything && rows + count.missing() < count.stored())
        count.set_missing(count.stored() - rows);
    }
    promised = std::max(promised, device.promised);
    std::uint64_t found = 0;
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

  void accept_damage() {
    if (how_ != Recovery::kEverything) return;
    for (v1::DamagedFile& one : *out_.manifest.mutable_damaged()) one.set_accepted(true);
  }

  FileSystem& files_;
  const std::filesystem::path& root_;
  Recovery how_;
  std::optional<v1::Manifest> before_;
  std::vector<v1::DamagedFile> damaged_;  // outside of the devices' folders
  std::set<std::uint32_t> unsettled_;     // replicates to be looked at again
  RecoveredRecording out_;
};

}  // namespace

Result<RecoveredRecording> recover_recording(FileSystem& files, const std::filesystem::path& root,
                                             Recovery how) {
  return RecordingRecovery(files, root, how).run();
}

}  // namespace imunoise::recording
