#include "daemon/acquire/record_replicate.h"

#include <fmt/format.h>

#include <algorithm>
#include <map>
#include <thread>
#include <utility>

#include "daemon/acquire/completeness.h"
#include "daemon/acquire/latecomer.h"
#include "daemon/acquire/recorded_device.h"
#include "daemon/acquire/start_stamp.h"
#include "daemon/acquire/wire_file.h"
#include "daemon/config/quantity_text.h"
#include "recording/store/format/layout.h"

namespace imunoise::acquire {
namespace {

using Steady = std::chrono::steady_clock;
using std::chrono::milliseconds;

constexpr milliseconds kWatchEvery{10};            // readers and the caller's wish to stop
constexpr milliseconds kLookEvery{500};            // at the disk and the clock
constexpr std::uint64_t kLittleRoom = 64'000'000;  // bytes

// From the host's clock, which began with this process, to the time of day.
std::int64_t shift_to(const Clock& clock) {
  const std::chrono::nanoseconds shift =
      clock.now().time_since_epoch() - std::chrono::nanoseconds(drivers::host_time_ns());
  return std::chrono::abs(shift) < kLeastLeap ? 0 : shift.count();
}

// One replicate, from its plan to its outcome; functions in the order in which they are called.
class Replicate {
 public:
  Replicate(recording::FileSystem& files, const ReplicatePlan& plan, const DeviceNote& tell,
            const Progress& progress)
      : files_(files), plan_(plan), tell_(tell), progress_(progress) {
    for (std::size_t i = 0; plan.wire && i < plan.devices.size(); ++i) {
      wires_.push_back(std::make_unique<WireFile>());
    }
  }

  Result<ReplicateOutcome> run() {
    auto opened = open_devices(
        plan_.devices, [this](std::size_t i) { return open(i, progress_.stop_token()); },
        plan_.patience, progress_);
    if (!opened) return tl::make_unexpected(opened.error());
    describe(*opened);
    if (auto room = check_disk(); !room) return tl::make_unexpected(room.error());
    auto recorder = recording::Recorder::start(files_, plan_.folder, recorded_, plan_.recorder);
    if (!recorder) return tl::make_unexpected(recorder.error());
    for (const std::string& one : (*recorder)->repaired()) {
      if (tell_) tell_("recording", one);
    }
    open_wires();
    if (plan_.observer != nullptr) {
      plan_.observer->begin(plan_, recorded_.devices);
      plan_.observer->watch([from = recorder->get()] { return from->state(); });
    }
    read(**recorder, *opened);
    if (plan_.observer != nullptr) plan_.observer->end();
    const auto closed = (*recorder)->close([this](const recording::RecorderState& state) {
      conclude(state);
      return note_;
    });
    if (!closed) return fail(closed.error().message + room_left());
    note_ = (*recorder)->note().value_or(note_);
    if (auto done = close_wires(); !done) return tl::make_unexpected(done.error());
    return outcome((*recorder)->state());
  }

 private:
  Result<std::unique_ptr<drivers::Device>> open(std::size_t i, const std::stop_token& stop) {
    drivers::WireHandler wire;
    if (!wires_.empty()) wire = [file = wires_[i].get()](auto bytes) { file->take(bytes); };
    auto device = open_device(plan_.devices[i], tell_, std::move(wire), stop);
    if (!device) return device;
    // What cannot be recorded is missing, and stops no other.
    if (auto good = recording::check_device(describe(i, **device)); !good)
      return fail(fmt::format("{}: {}", plan_.devices[i].name, good.error().message));
    return device;
  }

  void describe(const OpenDevices& opened) {
    recorded_.campaign = plan_.campaign;
    recorded_.replicate = plan_.replicate;
    recorded_.unfinished = plan_.unfinished;
    stamp_start(note_, *plan_.clock);
    leaps_.emplace(*plan_.clock);
    shift_ns_ = shift_to(*plan_.clock);
    recorded_.started_ns = note_.started_ns();
    for (std::size_t i = 0; i < opened.devices.size(); ++i) {
      if (opened.devices[i]) recorded_.devices.push_back(describe(i, *opened.devices[i]));
    }
    note_.set_replicate(plan_.replicate);
    note_.set_state(v1::open);
    note_.mutable_missing()->Add(opened.missing.begin(), opened.missing.end());
    recorded_.note = note_;
  }

  v1::RecordedDevice describe(std::size_t i, const drivers::Device& device) const {
    const DevicePlan& plan = plan_.devices[i];
    return recorded_device(plan.name, plan.driver.info.name, device.info());
  }

  // With an end in sight, everything that is to come must fit.
  Result<void> check_disk() const {
    if (!plan_.duration) return {};
    const auto free = files_.free_space(plan_.folder);
    if (!free) return tl::make_unexpected(free.error());
    const double replicates = 1.0 + plan_.replicates_to_come;
    return check_room(
        {recorded_.devices, plan_.duration->count() * replicates, plan_.reserve_bytes}, *free);
  }

  void open_wires() {
    for (std::size_t i = 0; i < wires_.size(); ++i) {
      wires_[i]->open(files_, plan_.folder / recording::replicate_folder(plan_.replicate) /
                                  (plan_.devices[i].name + ".wire"));
    }
  }

  void read(recording::Recorder& recorder, OpenDevices& opened) {
    for (std::size_t i = 0; i < opened.devices.size(); ++i) {
      if (opened.devices[i]) {
        start_reading(recorder, i, std::move(opened.devices[i]), 0.0);
      } else if (plan_.reopening) {
        latecomers_[i].latecomer = std::make_unique<Latecomer>(
            [this, i](const std::stop_token& stop) { return open(i, stop); }, *plan_.reopening);
      }
    }
    wait(recorder);
    for (const auto& [device, late] : latecomers_) late.latecomer->request_stop();
    for (const auto& reader : readers_) reader->request_stop();
    latecomers_.clear();
    for (const auto& reader : readers_) reader->stop();
  }

  // Reads device i of the plan, which is described as the last of the recorded ones that have no
  // reader yet. `from_s`: so long after the beginning.
  void start_reading(recording::Recorder& recorder, std::size_t i,
                     std::unique_ptr<drivers::Device> device, double from_s) {
    const std::size_t index = readers_.size();
    ReaderPlan one{index,
                   recorded_.devices[index],
                   plan_.devices[i].driver.info.name,
                   {},
                   {},
                   observer_of(index),
                   shift_ns_,
                   plan_.disk_patience};
    if (plan_.reopening) {
      one.open = [this, i](const std::stop_token& stop) { return open(i, stop); };
      one.reopening = *plan_.reopening;
    }
    readers_.push_back(std::make_unique<Reader>(recorder, std::move(one), std::move(device)));
    from_s_.push_back(from_s);
  }

  // Those that have come take part from now on, or as soon as the disk lets them.
  void welcome(recording::Recorder& recorder) {
    for (auto one = latecomers_.begin(); one != latecomers_.end();) {
      Late& late = one->second;
      if (!late.device) late.device = late.latecomer->take();
      const bool due = late.device && Steady::now() >= late.next;
      if (due && join(recorder, one->first, late.device)) {
        one = latecomers_.erase(one);
        continue;
      }
      if (due) late.next = Steady::now() + late.pause.next();
      ++one;
    }
  }

  // False: the disk failed, and the device is still there.
  bool join(recording::Recorder& recorder, std::size_t i,
            std::unique_ptr<drivers::Device>& device) {
    v1::RecordedDevice described = describe(i, *device);
    v1::MissingDevice& missing =
        *std::find_if(note_.mutable_missing()->begin(), note_.mutable_missing()->end(),
                      [&](const auto& one) { return one.device() == described.name(); });
    missing.set_joined_ns(stamp());
    recorder.annotate(note_);
    const auto added = recorder.add(described);
    if (!added) {
      missing.clear_joined_ns();
      missing.set_reason(added.error().message);
      recorder.annotate(note_);
      return false;
    }
    recorded_.devices.push_back(std::move(described));
    if (plan_.observer != nullptr) plan_.observer->join(recorded_.devices.back());
    start_reading(recorder, i, std::move(device),
                  std::chrono::duration<double>(Steady::now() - began_).count());
    return true;
  }

  std::function<void(const recording::Block&)> observer_of(std::size_t device) const {
    if (plan_.observer == nullptr) return {};
    return [to = plan_.observer, device](const auto& block) { to->take(device, block); };
  }

  // Until the plan's end, the readers', the disk's, or that of the caller's patience.
  void wait(recording::Recorder& recorder) {
    const Steady::time_point begin = began_ = Steady::now();
    Steady::time_point looked = begin;
    const auto over = [&] {
      if (progress_.stopped()) {
        if (plan_.duration) interruption_ = "stopped";
        return true;
      }
      if (std::all_of(readers_.begin(), readers_.end(), [](const auto& r) { return r->ended(); })) {
        return true;
      }
      if (Steady::now() - looked >= kLookEvery) {
        looked = Steady::now();
        if (plan_.observer != nullptr) plan_.observer->beat();
        look_at_clock();
        if (reserve_is_reached()) return true;
      }
      if (!plan_.duration) return false;
      const std::chrono::duration<double> passed = Steady::now() - begin;
      progress_.report(std::min(1.0, passed / *plan_.duration));
      return passed >= *plan_.duration;
    };
    while (!over()) {
      welcome(recorder);
      std::this_thread::sleep_for(kWatchEvery);
    }
  }

  // By the time stamps of this replicate.
  std::int64_t stamp() const { return drivers::host_time_ns() + shift_ns_; }

  // Time stamps go on as they began; by how much the time of day left them is noted.
  void look_at_clock() {
    const auto leap = leaps_->look();
    if (!leap) return;
    v1::ClockStep& step = *note_.add_clock_steps();
    step.set_noticed_ns(stamp());
    step.set_step_s(std::chrono::duration<double>(*leap).count());
    if (tell_)
      tell_("clock", "the clock of this machine was " + describe_leap(*leap) +
                         "; time "
                         "stamps go on as they began until the replicate ends");
  }

  bool reserve_is_reached() {
    const auto free = files_.free_space(plan_.folder);
    if (!free || *free >= plan_.reserve_bytes) return false;
    interruption_ = "the disk reserve was reached; free some space";
    return true;
  }

  // What the manifest will say, now that it is known what became of every row.
  void conclude(const recording::RecorderState& state) {
    look_at_clock();
    std::vector<v1::Disturbance> disturbances;
    std::size_t failed = 0;
    const bool to_the_end = plan_.duration && interruption_.empty();
    for (std::size_t i = 0; i < readers_.size(); ++i) {
      const Reader& reader = *readers_[i];
      // What is replayed ends with its files.
      const bool replayed = reader.ended() && recorded_.devices[i].driver() == "replay";
      const bool whole = to_the_end && !replayed && !reader.failure() && reader.connected();
      add_reason(shortfall(i, state, whole));
      const auto& seen = reader.disturbances();
      disturbances.insert(disturbances.end(), seen.begin(), seen.end());
      for (const v1::ClockComparison& clock : reader.clocks()) *note_.add_clocks() = clock;
      if (!reader.failure() && reader.connected()) continue;
      if (reader.failure()) ++failed;
      v1::MissingDevice& missing = *note_.add_missing();
      missing.set_device(recorded_.devices[i].name());
      missing.set_reason(reader.failure() ? reader.failure()->message : reader.disconnection());
    }
    for (const v1::Disturbance& one : merge_disturbances(std::move(disturbances))) {
      *note_.add_disturbances() = one;
    }
    if (interruption_.empty() && failed == readers_.size()) {
      interruption_ = note_.missing(note_.missing_size() - 1).reason();
    }
    note_.set_ended_ns(stamp());
    note_.set_state(interruption_.empty() ? v1::complete : v1::interrupted);
    note_.set_reason(interruption_);
  }

  void add_reason(const std::string& text) {
    if (!text.empty()) interruption_ += (interruption_.empty() ? "" : "; ") + text;
  }

  // Of the i-th recorded device, which should have come to the end or not.
  std::string shortfall(std::size_t i, const recording::RecorderState& state,
                        bool to_the_end) const {
    const Reader& reader = *readers_[i];
    DeviceCourse course{recorded_.devices[i], state.counts[i],       {},
                        reader.discarded(),   reader.disk_failure(), from_s_[i]};
    if (reader.last()) {
      course.last_s = std::chrono::duration<double>(*reader.last() - began_).count();
    }
    std::optional<double> planned_s;
    if (to_the_end) planned_s = plan_.duration->count();
    return acquire::shortfall(course, planned_s);
  }

  // Said of an error of the disk, when it may be full.
  std::string room_left() const {
    const auto free = files_.free_space(plan_.folder);
    if (!free || *free > plan_.reserve_bytes + kLittleRoom) return "";
    return fmt::format("; the disk of {} has {} free, make room", plan_.folder.string(),
                       config::print_bytes(static_cast<double>(*free)));
  }

  Result<void> close_wires() {
    for (const auto& wire : wires_) {
      if (auto done = wire->close(); !done) return done;
    }
    return {};
  }

  ReplicateOutcome outcome(const recording::RecorderState& state) const {
    ReplicateOutcome out{{}, note_};
    for (std::size_t i = 0; i < readers_.size(); ++i) {
      out.devices.push_back({recorded_.devices[i], state.counts[i], readers_[i]->disconnections(),
                             readers_[i]->failure()});
    }
    return out;
  }

  recording::FileSystem& files_;
  const ReplicatePlan& plan_;
  const DeviceNote& tell_;
  const Progress& progress_;
  std::vector<std::unique_ptr<WireFile>> wires_;  // by device; they outlive those, which write
  recording::RecordingPlan recorded_;
  v1::ReplicateNote note_;  // what the manifest will say
  std::vector<std::unique_ptr<Reader>> readers_;
  std::vector<double> from_s_;  // of each: when it began, s from the replicate's beginning
  std::string interruption_;
  Steady::time_point began_;  // when all readers had
  std::optional<LeapWatch> leaps_;
  std::int64_t shift_ns_ = 0;  // from the host's clock to this replicate's time stamps
  // One that did not answer in time.
  struct Late {
    std::unique_ptr<Latecomer> latecomer;
    std::unique_ptr<drivers::Device> device;  // it came, and the disk failed when it was to join
    recording::BackOff pause;
    Steady::time_point next = {};  // when it is tried again
  };
  std::map<std::size_t, Late> latecomers_;  // by device of the plan
};

}  // namespace

Result<ReplicateOutcome> record_replicate(recording::FileSystem& files, const ReplicatePlan& plan,
                                          const DeviceNote& note, const Progress& progress) {
  return Replicate(files, plan, note, progress).run();
}

}  // namespace imunoise::acquire
