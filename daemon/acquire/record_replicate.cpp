#include "daemon/acquire/record_replicate.h"

#include <fmt/format.h>

#include <algorithm>
#include <atomic>
#include <thread>
#include <utility>

#include "daemon/acquire/recorded_device.h"
#include "daemon/acquire/wire_file.h"
#include "recording/store/layout.h"

namespace imunoise::acquire {
namespace {

using Clock = std::chrono::steady_clock;
using std::chrono::milliseconds;

constexpr milliseconds kPatience{100};  // of one read, and of whoever watches the readers
constexpr std::size_t kBlockRows = 1024;

// One device's reader. Its thread is the only one that reads the device.
class Reader {
 public:
  Reader(recording::Recorder& recorder, std::size_t index, drivers::Device& device)
      : recorder_(recorder), index_(index), device_(device), thread_([this] { run(); }) {}
  ~Reader() { stop(); }
  Reader(const Reader&) = delete;
  Reader& operator=(const Reader&) = delete;

  void stop() {
    device_.cancel();
    if (thread_.joinable()) thread_.join();
  }
  bool ended() const { return ended_; }

  // After stop().
  std::uint64_t disconnections() const { return disconnections_; }
  const std::optional<Error>& failure() const { return failure_; }
  const std::optional<Error>& disk_failure() const { return disk_failure_; }

 private:
  void run() {
    drivers::Block block = device_.make_block(kBlockRows);
    while (step(block)) {
    }
    ended_ = true;
  }

  // False when there is nothing more to read.
  bool step(drivers::Block& block) {
    const auto outcome = device_.read(kPatience, block);
    if (!outcome) {
      failure_ = outcome.error();
      return false;
    }
    switch (*outcome) {
      case drivers::ReadOutcome::kSamples:
        if (const auto taken = recorder_.push(index_, recorded_block(block)); !taken) {
          disk_failure_ = taken.error();
          return false;
        }
        connected_ = true;
        return true;
      case drivers::ReadOutcome::kTimeout:
        return true;
      case drivers::ReadOutcome::kDisconnected:
        if (connected_) ++disconnections_;
        connected_ = false;
        return true;
      case drivers::ReadOutcome::kCancelled:
      case drivers::ReadOutcome::kEnd:
        break;
    }
    return false;
  }

  recording::Recorder& recorder_;
  std::size_t index_;
  drivers::Device& device_;
  bool connected_ = true;
  std::uint64_t disconnections_ = 0;
  std::optional<Error> failure_;
  std::optional<Error> disk_failure_;
  std::atomic<bool> ended_ = false;
  std::thread thread_;  // last: it uses all of the above
};

// By device; none where wires are not recorded. They outlive the devices, which write into them.
using WireFiles = std::vector<std::unique_ptr<WireFile>>;

WireFiles make_wire_files(const ReplicatePlan& plan) {
  WireFiles out;
  for (std::size_t i = 0; plan.wire && i < plan.devices.size(); ++i) {
    out.push_back(std::make_unique<WireFile>());
  }
  return out;
}

void open_wire_files(recording::FileSystem& files, const ReplicatePlan& plan,
                     const WireFiles& wires) {
  for (std::size_t i = 0; i < wires.size(); ++i) {
    wires[i]->open(files, plan.folder / recording::replicate_folder(plan.replicate) /
                              (plan.devices[i].name + ".wire"));
  }
}

Result<std::vector<std::unique_ptr<drivers::Device>>> open_devices(const ReplicatePlan& plan,
                                                                   const DeviceNote& note,
                                                                   const WireFiles& wires) {
  std::vector<std::unique_ptr<drivers::Device>> out;
  for (const DevicePlan& one : plan.devices) {
    drivers::WireHandler wire;
    if (!wires.empty()) {
      wire = [file = wires[out.size()].get()](auto bytes) { file->take(bytes); };
    }
    auto device = drivers::Device::open(
        one.driver, one.options,
        [note, name = one.name](std::string_view text) {
          if (note) note(name, text);
        },
        std::move(wire));
    if (!device) return fail(fmt::format("{}: {}", one.name, device.error().message));
    out.push_back(std::move(*device));
  }
  return out;
}

// Waits for the end of the plan, of all readers, or of the caller's patience.
void wait(const ReplicatePlan& plan, const std::vector<std::unique_ptr<Reader>>& readers,
          const Progress& progress) {
  const Clock::time_point begin = Clock::now();
  const auto over = [&] {
    if (progress.stopped()) return true;
    if (std::all_of(readers.begin(), readers.end(), [](const auto& r) { return r->ended(); })) {
      return true;
    }
    if (!plan.duration) return false;
    const std::chrono::duration<double> passed = Clock::now() - begin;
    progress.report(std::min(1.0, passed / *plan.duration));
    return passed >= *plan.duration;
  };
  while (!over()) std::this_thread::sleep_for(kPatience / 10);
}

std::int64_t now_ns() {
  return std::chrono::duration_cast<std::chrono::nanoseconds>(
             std::chrono::system_clock::now().time_since_epoch())
      .count();
}

}  // namespace

Result<std::vector<DeviceOutcome>> record_replicate(recording::FileSystem& files,
                                                    const ReplicatePlan& plan,
                                                    const DeviceNote& note,
                                                    const Progress& progress) {
  const WireFiles wires = make_wire_files(plan);
  const auto devices = open_devices(plan, note, wires);
  if (!devices) return tl::make_unexpected(devices.error());
  recording::RecordingPlan recorded;
  recorded.replicate = plan.replicate;
  recorded.started_ns = now_ns();
  for (std::size_t i = 0; i < devices->size(); ++i) {
    recorded.devices.push_back(recorded_device(
        plan.devices[i].name, plan.devices[i].driver.info.name, (*devices)[i]->info()));
  }
  const auto recorder = recording::Recorder::start(files, plan.folder, recorded);
  if (!recorder) return tl::make_unexpected(recorder.error());
  open_wire_files(files, plan, wires);

  std::vector<std::unique_ptr<Reader>> readers;
  for (std::size_t i = 0; i < devices->size(); ++i) {
    readers.push_back(std::make_unique<Reader>(**recorder, i, *(*devices)[i]));
  }
  wait(plan, readers, progress);
  for (const auto& reader : readers) reader->stop();
  const auto closed = (*recorder)->close();

  for (const auto& reader : readers) {
    if (reader->disk_failure()) return tl::make_unexpected(*reader->disk_failure());
  }
  if (!closed) return tl::make_unexpected(closed.error());
  for (const auto& wire : wires) {
    if (const auto done = wire->close(); !done) return tl::make_unexpected(done.error());
  }
  const recording::RecorderState state = (*recorder)->state();
  std::vector<DeviceOutcome> out;
  for (std::size_t i = 0; i < readers.size(); ++i) {
    out.push_back({recorded.devices[i], state.counts[i], readers[i]->disconnections(),
                   readers[i]->failure()});
  }
  return out;
}

}  // namespace imunoise::acquire
