#include "recording/store/recovery/recover.h"

#include <fmt/core.h>
#include <google/protobuf/util/message_differencer.h>

#include <algorithm>
#include <set>
#include <utility>

#include "recording/store/format/layout.h"
#include "recording/store/manifest/replicate_set.h"

namespace imunoise::recording {
namespace {

using google::protobuf::util::MessageDifferencer;

// Recovers a recording, any of whose manifests may be lost.
class RecordingRecovery {
 public:
  RecordingRecovery(FileSystem& files, const std::filesystem::path& root, Recovery how,
                    const Circumstances& circumstances)
      : files_(files), root_(root), how_(how), circumstances_(circumstances) {}

  Result<RecoveredRecording> run() {
    if (auto done = take_manifest(); !done) return tl::make_unexpected(done.error());
    const auto nothing = nothing_to_recover();
    if (!nothing) return tl::make_unexpected(nothing.error());
    if (*nothing) return std::move(out_);
    auto names = files_.list(root_);
    if (!names) return tl::make_unexpected(names.error());
    names_ = std::move(*names);
    record_broken_manifests();
    for (const std::uint32_t replicate : to_recover()) {
      if (auto done = recover_one(replicate); !done) return tl::make_unexpected(done.error());
    }
    if (how_ == Recovery::kEverything) {
      for (v1::DamagedFile& one : *out_.manifest.mutable_damaged()) one.set_accepted(true);
    }
    out_.manifest.set_closed(true);
    out_.changed = !before_ || one_file_ || !MessageDifferencer::Equals(*before_, out_.manifest);
    return std::move(out_);
  }

 private:
  bool there(const std::string& name) const {
    return std::binary_search(names_.begin(), names_.end(), name);
  }

  // A damaged manifest.json is set aside.
  Result<void> take_manifest() {
    const std::string name(kManifestName);
    const auto begun = files_.exists(root_ / name);
    if (!begun) return tl::make_unexpected(begun.error());
    if (!*begun) return {};
    const auto text = read_manifest_text(files_, root_ / name);
    if (!text) return tl::make_unexpected(text.error());
    auto manifest = parse_recording_manifest((root_ / name).string(), *text);
    if (!manifest) return set_manifest_aside(name, *text, manifest.error());
    before_ = out_.manifest = std::move(manifest->recording);
    one_file_ = manifest->replicates.has_value();
    if (one_file_) known_ = std::move(*manifest->replicates);
    return {};
  }

  // The usual start of a replicate: the recording was closed, all its replicates are settled, and
  // the next one is new. A folder of a thousand replicates takes longer to list than to sync.
  Result<bool> nothing_to_recover() const {
    const std::uint32_t next = circumstances_.next;
    if (how_ != Recovery::kUnsettled || !before_ || one_file_ || !before_->closed()) return false;
    if (before_->settled_size() != 1) return false;
    const v1::ReplicateRange& settled = before_->settled(0);
    if (settled.first() != 1 || std::uint64_t{settled.last()} + 1 != next) return false;
    for (const std::string& name : {replicate_folder(next), replicate_manifest(next)}) {
      const auto there = files_.exists(root_ / name);
      if (!there) return tl::make_unexpected(there.error());
      if (*there) return false;
    }
    return true;
  }

  Result<void> set_manifest_aside(const std::string& name, const std::string& text,
                                  const Error& error) {
    if (of_other_version(text)) return tl::make_unexpected(error);
    const auto aside = set_aside(files_, root_, name);
    if (!aside) return tl::make_unexpected(aside.error());
    out_.repaired.push_back(fmt::format("{}: set aside as {}", error.message, *aside));
    record(name, *aside, error.message);
    return {};
  }

  void record(const std::string& name, const std::string& aside, const std::string& reason) {
    v1::DamagedFile damaged;
    damaged.set_file(name);
    damaged.set_kept_as(aside);
    damaged.set_reason(reason);
    set_damaged(*out_.manifest.mutable_damaged(), damaged);
  }

  // Those that an earlier recovery set aside, and could not put on record.
  void record_broken_manifests() {
    for (const std::string& name : names_) {
      if (!is_broken(name)) continue;
      const std::string before(name_before(name));
      const auto& damaged = out_.manifest.damaged();
      const bool known = std::any_of(damaged.begin(), damaged.end(),
                                     [&](const auto& one) { return one.kept_as() == name; });
      if (!known && (before == kManifestName || replicate_of_manifest(before)))
        record(before, name, "was damaged and set aside before");
    }
  }

  bool settled(std::uint32_t replicate) const {
    return how_ == Recovery::kUnsettled && before_ && holds(before_->settled(), replicate);
  }

  // All that have a folder or a manifest, or should have one. Those that are settled are only
  // converted.
  std::set<std::uint32_t> to_recover() const {
    std::set<std::uint32_t> out;
    for (const std::string& name : names_) {
      const auto replicate = name.ends_with('/') ? replicate_of(name.substr(0, name.size() - 1))
                                                 : replicate_of_manifest(name);
      if (replicate && !settled(*replicate)) out.insert(*replicate);
    }
    for (const auto& [replicate, manifest] : known_) out.insert(replicate);
    if (how_ == Recovery::kUnsettled || !before_) return out;
    for (const v1::ReplicateRange& range : before_->settled()) {
      for (std::uint64_t i = range.first(); i <= range.last(); ++i)
        out.insert(static_cast<std::uint32_t>(i));
    }
    return out;
  }

  Result<void> recover_one(std::uint32_t replicate) {
    const auto read = replicate_manifest_of(replicate);
    if (!read) return tl::make_unexpected(read.error());
    const v1::ReplicateManifest known = read->value_or(v1::ReplicateManifest());
    RecoveredReplicate now{known, {}, true, {}};
    if (!settled(replicate)) {
      auto recovered = recover_replicate(files_, root_, replicate, out_.manifest, known, how_,
                                         circumstances_.unfinished);
      if (!recovered) return tl::make_unexpected(recovered.error());
      now = std::move(*recovered);
    }
    for (const v1::RecordedDevice& device : now.devices) add_device(out_.manifest, device);
    out_.repaired.insert(out_.repaired.end(), now.repaired.begin(), now.repaired.end());
    settle(replicate, now.settled);
    if (*read && !one_file_ && MessageDifferencer::Equals(known, now.manifest)) return {};
    if (!one_file_) {
      out_.repaired.push_back(fmt::format("{}: {}", replicate_manifest(replicate),
                                          *read ? "brought up to date" : "made from the chunks"));
    }
    return write_replicate_manifest(files_, root_, replicate, now.manifest);
  }

  void settle(std::uint32_t replicate, bool settled) {
    auto& all = *out_.manifest.mutable_settled();
    if (settled) {
      insert(all, replicate);
    } else {
      erase(all, replicate);
    }
  }

  // Nothing: there is none. A damaged one is set aside.
  Result<std::optional<v1::ReplicateManifest>> replicate_manifest_of(std::uint32_t replicate) {
    using Found = std::optional<v1::ReplicateManifest>;
    if (one_file_) {
      const auto known = known_.find(replicate);
      return known == known_.end() ? Found() : Found(known->second);
    }
    const std::string name = replicate_manifest(replicate);
    if (!there(name)) {
      if (before_ && holds(before_->settled(), replicate)) record(name, "", name + ": is missing");
      return Found();
    }
    const auto text = read_manifest_text(files_, root_ / name);
    if (!text) return tl::make_unexpected(text.error());
    auto manifest = parse_replicate_manifest((root_ / name).string(), *text, replicate);
    if (manifest) return Found(std::move(*manifest));
    if (auto done = set_manifest_aside(name, *text, manifest.error()); !done)
      return tl::make_unexpected(done.error());
    return Found();
  }

  FileSystem& files_;
  const std::filesystem::path& root_;
  Recovery how_;
  const Circumstances& circumstances_;
  std::vector<std::string> names_;  // in the folder, sorted
  std::optional<v1::RecordingManifest> before_;
  bool one_file_ = false;                                 // manifest.json has everything: version 1
  std::map<std::uint32_t, v1::ReplicateManifest> known_;  // in that file
  RecoveredRecording out_;
};

}  // namespace

Result<RecoveredRecording> recover_replicates(FileSystem& files, const std::filesystem::path& root,
                                              Recovery how, const Circumstances& known) {
  return RecordingRecovery(files, root, how, known).run();
}

Result<RecoveredRecording> recover_recording(FileSystem& files, const std::filesystem::path& root,
                                             Recovery how) {
  auto out = recover_replicates(files, root, how);
  if (!out || !out->changed) return out;
  const bool there = out->manifest.version() != 0;
  if (auto done = write_recording_manifest(files, root, out->manifest); !done)
    return tl::make_unexpected(done.error());
  out->repaired.push_back(fmt::format("{}: {}", (root / kManifestName).string(),
                                      there ? "brought up to date" : "made from the chunks"));
  return out;
}

}  // namespace imunoise::recording
