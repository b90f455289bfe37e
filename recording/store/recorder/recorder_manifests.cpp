#include "recording/store/recorder/recorder_manifests.h"

#include <utility>

#include "recording/store/format/layout.h"
#include "recording/store/manifest/replicate_set.h"

namespace imunoise::recording {
namespace {

// That of a replicate which other devices were recorded in before, or an empty one.
Result<v1::ReplicateManifest> own_manifest(const FileSystem& files,
                                           const std::filesystem::path& folder,
                                           std::uint32_t replicate) {
  const std::filesystem::path file = folder / replicate_manifest(replicate);
  const auto there = files.exists(file);
  if (!there) return tl::make_unexpected(there.error());
  if (!*there) return v1::ReplicateManifest();
  const auto text = read_manifest_text(files, file);
  if (!text) return tl::make_unexpected(text.error());
  return parse_replicate_manifest(file.string(), *text, replicate);
}

}  // namespace

Result<RecorderManifests> RecorderManifests::open(FileSystem& files,
                                                  const std::filesystem::path& folder,
                                                  const RecordingPlan& plan) {
  auto recovered =
      recover_replicates(files, folder, Recovery::kUnsettled, {plan.unfinished, plan.replicate});
  if (!recovered) return tl::make_unexpected(recovered.error());
  auto own = own_manifest(files, folder, plan.replicate);
  if (!own) return tl::make_unexpected(own.error());
  RecorderManifests out(folder, plan.replicate, std::move(*recovered));
  v1::RecordingManifest& recording = out.recording_;
  if (recording.started_ns() == 0) recording.set_started_ns(plan.started_ns);
  if (recording.campaign().empty()) recording.set_campaign(plan.campaign);
  for (const v1::RecordedDevice& device : plan.devices) {
    if (auto same = out.check(device); !same) return tl::make_unexpected(same.error());
    add_device(recording, device);
  }
  out.own_ = std::move(*own);
  if (plan.note) {
    v1::ReplicateNote note = *plan.note;
    note.set_state(v1::open);
    note.set_started_ns(plan.started_ns);
    out.set_note(std::move(note));
  }
  return out;
}

Result<void> RecorderManifests::begin(FileSystem& files) {
  recording_.set_closed(false);
  erase(*recording_.mutable_settled(), replicate_);
  if (auto done = write_recording_manifest(files, folder_, recording_); !done) return done;
  return write_replicate_manifest(files, folder_, replicate_, own_);
}

Result<void> RecorderManifests::check(const v1::RecordedDevice& device) const {
  auto same = check_same(recording_, device);
  if (!same) return fail(folder_.string() + ": " + same.error().message);
  return {};
}

Result<void> RecorderManifests::add(FileSystem& files, const v1::RecordedDevice& device) {
  const v1::RecordingManifest before = recording_;
  add_device(recording_, device);
  auto done = begin(files);
  if (!done) recording_ = before;
  return done;
}

Result<void> RecorderManifests::end(FileSystem& files, bool closed, bool settled) {
  sort_chunks(own_);
  if (own_.has_note()) own_.mutable_note()->set_settled(settled);
  if (auto done = write_replicate_manifest(files, folder_, replicate_, own_); !done) return done;
  recording_.set_closed(closed);
  if (settled) insert(*recording_.mutable_settled(), replicate_);
  return write_recording_manifest(files, folder_, recording_);
}

void RecorderManifests::set_note(v1::ReplicateNote note) {
  note.set_replicate(replicate_);
  *own_.mutable_note() = std::move(note);
}

}  // namespace imunoise::recording
