#include "daemon/acquire/reader.h"

#include <fmt/format.h>
#include <google/protobuf/util/message_differencer.h>

#include <algorithm>
#include <utility>

#include "daemon/acquire/recorded_device.h"

namespace imunoise::acquire {
namespace {

using Steady = std::chrono::steady_clock;

constexpr std::chrono::milliseconds kPatience{100};  // of one read
constexpr std::size_t kBlockRows = 1024;
constexpr std::chrono::milliseconds kDiskSlice{250};  // of waiting for the disk's room
constexpr std::chrono::seconds kLastDiskPatience{2};  // once the reader is to stop

}  // namespace

Reader::Reader(recording::Recorder& recorder, ReaderPlan plan,
               std::unique_ptr<drivers::Device> device)
    : recorder_(recorder),
      plan_(std::move(plan)),
      stillness_(plan_.device),
      lost_(static_cast<std::size_t>(plan_.device.streams_size()), false),
      pause_(plan_.reopening.first),
      disk_patience_(plan_.disk_patience),
      device_(std::move(device)),
      thread_([this] { run(); }) {}

void Reader::request_stop() {
  {
    const std::lock_guard lock(mutex_);
    stop_.request_stop();
    if (device_) device_->cancel();
  }
  stopping_.notify_all();
}

void Reader::stop() {
  request_stop();
  if (thread_.joinable()) thread_.join();
}

void Reader::run() {
  do {
    drivers::SampleBlock block = device_->make_block(kBlockRows);
    while (step(block)) {
    }
  } while (failure_ && plan_.open && open_again());
  ended_ = true;
}

// False when there is nothing more to read.
bool Reader::step(drivers::SampleBlock& block) {
  const auto outcome = device_->read(kPatience, block);
  if (!outcome) {
    failure_ = outcome.error();
    return false;
  }
  switch (*outcome) {
    case drivers::ReadOutcome::kSamples:
      connected_ = true;
      pause_ = plan_.reopening.first;
      return push(block);
    case drivers::ReadOutcome::kTimeout:
      return true;
    case drivers::ReadOutcome::kDisconnected:
      if (connected_) ++disconnections_;
      connected_ = false;
      disconnection_ = device_->disconnection();
      return true;
    case drivers::ReadOutcome::kCancelled:
    case drivers::ReadOutcome::kEnd:
      break;
  }
  return false;
}

// False when the block does not fit the device's description, for which no disk is to blame.
bool Reader::push(const drivers::SampleBlock& block) {
  recording::Block taken = recorded_block(block);
  if (auto good = recording::check_block(plan_.device, taken); !good) {
    failure_ = Error{fmt::format(
        "driver {}: {} rows do not fit what it said of the device ({}) and are not recorded; this "
        "is a fault of the driver, report it to its author",
        plan_.driver, taken.rows.received, good.error().message)};
    return false;
  }
  for (std::int64_t& time : taken.rows.host_time) time += plan_.shift_ns;
  if (lost_[taken.stream] && !taken.rows.flags.empty()) {
    taken.rows.flags.front() |= recording::kLostBefore;
    lost_[taken.stream] = false;
  }
  stillness_.take(taken);
  clocks_.take(block);
  if (plan_.observe) plan_.observe(taken);
  if (taken.rows.size() > 0) last_ = Steady::now();
  return deliver(taken);
}

// Whatever the disk does, the device is read on in the end, and every row is counted.
bool Reader::deliver(const recording::Block& block) {
  if (Steady::now() >= disk_next_) {
    const auto taken = push_patiently(block);
    if (taken && *taken) {
      disk_patience_ = plan_.disk_patience;
      disk_pause_.reset();
      return true;
    }
    disk_failure_ = taken ? "it accepted no samples for too long" : taken.error().message;
    disk_patience_ = {};  // enough was waited; from now on what finds no room is counted
    disk_next_ = Steady::now() + disk_pause_.next();
  }
  const auto room = recorder_.offer(plan_.index, block);
  if (!room) {
    failure_ = room.error();
    return false;
  }
  if (!*room) discarded_ += block.rows.size();
  return true;
}

// False: there was no room in time. Error: the disk's.
Result<bool> Reader::push_patiently(const recording::Block& block) {
  const Steady::time_point begin = Steady::now();
  recording::BackOff pause;
  while (true) {
    auto taken = recorder_.push_for(plan_.index, block, kDiskSlice);
    const Steady::duration patience =
        stop_.stop_requested() ? std::min<Steady::duration>(disk_patience_, kLastDiskPatience)
                               : disk_patience_;
    if ((taken && *taken) || Steady::now() - begin >= patience) return taken;
    if (taken) continue;  // that was a wait
    std::this_thread::sleep_for(pause.next());
  }
}

std::vector<v1::ClockComparison> Reader::clocks() const {
  auto out = clocks_.comparisons(plan_.device.name());
  for (v1::ClockComparison& one : out)
    one.set_first_sample_ns(one.first_sample_ns() + plan_.shift_ns);
  return out;
}

// Waits, opens, waits longer. False when it was told to stop before.
bool Reader::open_again() {
  if (connected_) ++disconnections_;
  connected_ = false;  // until samples come
  lost_.assign(lost_.size(), true);
  std::unique_lock lock(mutex_);
  device_.reset();
  while (!stopping_.wait_for(lock, pause_, [&] { return stop_.stop_requested(); })) {
    pause_ = std::min(2 * pause_, plan_.reopening.longest);
    lock.unlock();
    auto opened = same_device();
    lock.lock();
    if (stop_.stop_requested()) return false;
    if (opened) {
      device_ = std::move(*opened);
      disconnection_ = std::exchange(failure_, std::nullopt)->message;
      return true;
    }
    failure_ = opened.error();
  }
  return false;
}

// Error: it does not open, or is another device now.
Result<std::unique_ptr<drivers::Device>> Reader::same_device() const {
  auto device = plan_.open(stop_.get_token());
  if (!device) return device;
  const v1::RecordedDevice now =
      recorded_device(plan_.device.name(), plan_.driver, (*device)->info());
  if (google::protobuf::util::MessageDifferencer::Equals(now, plan_.device)) return device;
  return fail(fmt::format(
      "{} (serial {}) stands where {} (serial {}) was, or it is set up in another way; "
      "it takes part again from the next replicate on",
      now.driver(), now.serial().empty() ? "unknown" : now.serial(), plan_.device.driver(),
      plan_.device.serial().empty() ? "unknown" : plan_.device.serial()));
}

}  // namespace imunoise::acquire
