#include "recording/store/recorder.h"

#include <set>
#include <utility>

#include "recording/store/recorder_threads.h"
#include "recording/store/recover.h"

namespace imunoise::recording {
namespace {

// Recovers what is there and adds the plan's devices. Their chunks come when the recorder closes.
Result<v1::Manifest> open_manifest(FileSystem& files, const std::filesystem::path& folder,
                                   const RecordingPlan& plan) {
  auto recovered = recover_recording(files, folder);
  if (!recovered) return tl::make_unexpected(recovered.error());
  v1::Manifest manifest = std::move(recovered->manifest);
  if (manifest.started_ns() == 0) manifest.set_started_ns(plan.started_ns);
  if (manifest.campaign().empty()) manifest.set_campaign(plan.campaign);
  for (const v1::RecordedDevice& device : plan.devices) add_device(manifest, device);
  end_open_replicates(manifest, plan.unfinished);
  if (plan.note) {
    v1::ReplicateNote note = *plan.note;
    note.set_replicate(plan.replicate);
    note.set_state(v1::open);
    note.set_started_ns(plan.started_ns);
    set_note(manifest, note);
  }
  manifest.set_closed(false);
  return manifest;
}

Result<void> check_plan(const RecordingPlan& plan) {
  if (plan.devices.empty()) return fail("no device is to be recorded; name one");
  if (plan.replicate == 0) return fail("replicates are numbered from 1");
  std::set<std::string> names;
  for (const v1::RecordedDevice& device : plan.devices) {
    if (auto good = check_new(device, names); !good) return good;
  }
  return {};
}

}  // namespace

Recorder::Recorder(std::unique_ptr<Threads> threads) : threads_(std::move(threads)) {}
Recorder::~Recorder() = default;

Result<std::unique_ptr<Recorder>> Recorder::start(FileSystem& files,
                                                  const std::filesystem::path& folder,
                                                  const RecordingPlan& plan,
                                                  const RecorderOptions& options) {
  if (auto good = check_plan(plan); !good) return tl::make_unexpected(good.error());
  if (auto done = files.make_folder(folder); !done) return tl::make_unexpected(done.error());
  auto lock = files.lock(folder);
  if (!lock) return tl::make_unexpected(lock.error());
  auto manifest = open_manifest(files, folder, plan);
  if (!manifest) return tl::make_unexpected(manifest.error());
  auto threads = std::make_unique<Threads>(files, folder, std::move(*lock), std::move(*manifest),
                                           plan.replicate, options);
  if (auto done = threads->add_devices(plan.devices); !done) {
    return tl::make_unexpected(done.error());
  }
  if (auto done = threads->run(); !done) return tl::make_unexpected(done.error());
  return std::unique_ptr<Recorder>(new Recorder(std::move(threads)));
}

Result<bool> Recorder::offer(std::size_t device, Block block) {
  return threads_->offer(device, std::move(block));
}

Result<void> Recorder::push(std::size_t device, const Block& block) {
  const auto taken = threads_->push(device, block, std::nullopt);
  if (!taken) return tl::make_unexpected(taken.error());
  return {};
}

Result<bool> Recorder::push_for(std::size_t device, const Block& block,
                                std::chrono::milliseconds patience) {
  return threads_->push(device, block, patience);
}

RecorderState Recorder::state() const { return threads_->state(); }

void Recorder::annotate(const v1::ReplicateNote& note) { threads_->annotate(note); }

Result<std::size_t> Recorder::add(const v1::RecordedDevice& device) {
  return threads_->add(device);
}

Result<void> Recorder::close(const Conclusion& conclude) { return threads_->close(conclude); }

}  // namespace imunoise::recording
