#include "recording/store/recorder/recorder.h"

#include <set>
#include <utility>

#include "recording/store/format/layout.h"
#include "recording/store/recorder/recorder_threads.h"

namespace imunoise::recording {
namespace {

// Makes the folder. Its name survives a power cut before anything in it is acknowledged: later than
// the first manifest it is there for good.
Result<void> make_root(FileSystem& files, const std::filesystem::path& folder) {
  if (auto done = make_folders(files, folder); !done) return done;
  const auto begun = files.exists(folder / kManifestName);
  if (!begun) return tl::make_unexpected(begun.error());
  if (*begun) return {};
  const std::filesystem::path name = folder.has_filename() ? folder : folder.parent_path();
  return files.sync_folder(name.has_parent_path() ? name.parent_path() : ".");
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
  if (auto done = make_root(files, folder); !done) return tl::make_unexpected(done.error());
  auto lock = files.lock(folder);
  if (!lock) return tl::make_unexpected(lock.error());
  auto manifests = RecorderManifests::open(files, folder, plan);
  if (!manifests) return tl::make_unexpected(manifests.error());
  auto threads =
      std::make_unique<Threads>(files, folder, std::move(*lock), std::move(*manifests), options);
  if (auto done = threads->add_devices(plan.devices); !done) {
    return tl::make_unexpected(done.error());
  }
  if (auto done = threads->run(); !done) return tl::make_unexpected(done.error());
  return std::unique_ptr<Recorder>(new Recorder(std::move(threads)));
}

const std::vector<std::string>& Recorder::repaired() const { return threads_->repaired(); }

std::optional<v1::ReplicateNote> Recorder::note() const { return threads_->note(); }

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
