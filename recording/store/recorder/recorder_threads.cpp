#include "recording/store/recorder/recorder_threads.h"

#include <fmt/core.h>

#include <algorithm>
#include <utility>

#include "core/support/counted.h"
#include "recording/store/disk/back_off.h"
#include "recording/store/recorder/replicate_counts.h"
#include "recording/store/recovery/seal.h"

namespace imunoise::recording {
namespace {

// At the close no later round tries again what failed: a disk that fails once must cost nothing.
constexpr int kLastAttempts = 3;

}  // namespace

Result<void> check_new(const v1::RecordedDevice& device, std::set<std::string>& names) {
  if (auto good = check_device(device); !good)
    return fail(fmt::format("device {}: {}", device.name(), good.error().message));
  if (!names.insert(device.name()).second)
    return fail(fmt::format("two devices are named '{}'; rename one", device.name()));
  return {};
}

Recorder::Threads::Threads(FileSystem& files, std::filesystem::path folder,
                           std::unique_ptr<FolderLock> lock, RecorderManifests manifests,
                           const RecorderOptions& options)
    : files_(files, calls_),
      folder_(std::move(folder)),
      lock_(std::move(lock)),
      manifests_(std::move(manifests)),
      options_(options) {}

Result<void> Recorder::Threads::add_devices(const std::vector<v1::RecordedDevice>& devices) {
  for (std::size_t i = 0; i < devices.size(); ++i) {
    auto where = make_device_folder(files_, folder_, manifests_.replicate(), devices[i].name());
    if (!where) return tl::make_unexpected(where.error());
    const double share = static_cast<double>(i + 1) / static_cast<double>(devices.size());
    append(devices[i], std::move(*where), share);
  }
  return {};
}

Result<std::size_t> Recorder::Threads::add(const v1::RecordedDevice& device) {
  std::set<std::string> names;  // only this function adds to them, once it records
  for (const Line& line : lines_) names.insert(line.device.name());
  if (auto good = check_new(device, names); !good) return tl::make_unexpected(good.error());
  if (auto same = manifests_.check(device); !same) return tl::make_unexpected(same.error());
  auto where = make_device_folder(files_, folder_, manifests_.replicate(), device.name());
  if (!where) return tl::make_unexpected(where.error());
  if (auto done = manifests_.add(files_, device); !done) return tl::make_unexpected(done.error());
  append(device, std::move(*where), 1.0);
  return lines_.size() - 1;
}

Result<void> Recorder::Threads::run() {
  if (auto done = manifests_.begin(files_); !done) return done;
  journal_thread_ = std::thread([this] { run_journals(); });
  chunk_thread_ = std::thread([this] { run_chunks(); });
  return {};
}

Result<bool> Recorder::Threads::offer(std::size_t device, Block block) {
  if (auto good = check(device, block); !good) return tl::make_unexpected(good.error());
  const std::lock_guard guard(mutex_);
  Intake& intake = lines_[device].intake;
  const bool room = intake.has_room(block.rows.size());
  if (room) {
    intake.add(std::move(block));
  } else {
    intake.refuse(block);
  }
  wake_journals(lines_[device].presses());
  return room;
}

Result<bool> Recorder::Threads::push(std::size_t device, const Block& block,
                                     std::optional<std::chrono::milliseconds> patience) {
  if (auto good = check(device, block); !good) return tl::make_unexpected(good.error());
  std::unique_lock guard(mutex_);
  Line& line = lines_[device];
  const std::uint64_t failures = line.journal_disk.failures();
  const auto room = [&] { return line.intake.has_room(block.rows.size()); };
  const auto decided = [&] { return room() || line.journal_disk.failures() != failures; };
  if (!room()) wake_journals(true);
  if (!patience) {
    room_.wait(guard, decided);
  } else if (!room_.wait_for(guard, *patience, decided)) {
    return false;
  }
  if (!room()) return tl::make_unexpected(line.journal_disk.last_error());
  line.intake.add(block);
  wake_journals(line.presses());
  return true;
}

RecorderState Recorder::Threads::state() const {
  RecorderState out;
  out.calls = calls_.pending();
  const std::lock_guard guard(mutex_);
  for (const Line& line : lines_) {
    out.counts.push_back(line.intake.counts());
    out.acknowledged.push_back(line.acknowledged);
    const auto call = std::find_if(out.calls.begin(), out.calls.end(), [&](const DiskCall& one) {
      return one.path == line.where.path() || one.path.parent_path() == line.where.path();
    });
    DeviceDisk& disk = out.disks.emplace_back();
    disk.trouble =
        line.journal_disk.trouble() ? line.journal_disk.trouble() : line.chunk_disk.trouble();
    if (call != out.calls.end()) disk.call = *call;
  }
  return out;
}

Result<void> Recorder::Threads::close(const Conclusion& conclude) {
  if (!journal_thread_.joinable()) return outcome_;
  {
    const std::lock_guard guard(mutex_);
    for (Line& line : lines_) line.intake.flush_refusals();
    closing_ = true;
    wake_journals(true);
  }
  journal_thread_.join();
  {
    const std::lock_guard guard(mutex_);
    journals_done_ = true;
    for (Line& line : lines_) line.intake.give_up();
  }
  chunks_.notify_one();
  chunk_thread_.join();
  outcome_ = finish(conclude);
  lock_.reset();
  return outcome_;
}

// `first_share` of the limits ends its first segment.
void Recorder::Threads::append(const v1::RecordedDevice& device, DeviceFolder where,
                               double first_share) {
  Journal journal(files_, where.path(), device, JournalPlace{manifests_.replicate(), 1, 1},
                  options_.segments, first_share);
  const std::lock_guard guard(mutex_);
  lines_.emplace_back(device, std::move(where), std::move(journal),
                      Intake(device, options_.waiting_rows));
}

Recorder::Threads::Line& Recorder::Threads::found(std::size_t device) {
  const std::lock_guard guard(mutex_);
  return lines_[device];
}

Result<void> Recorder::Threads::check(std::size_t device, const Block& block) {
  const v1::RecordedDevice& of = found(device).device;
  auto good = check_block(of, block);
  if (good) return good;
  return fail(fmt::format("device {}: {}", of.name(), good.error().message));
}

// The lock is held. What is not urgent waits for the next round.
void Recorder::Threads::wake_journals(bool urgent) {
  if (!work_ || (urgent && !urgent_)) journal_.notify_one();
  work_ = true;
  urgent_ = urgent_ || urgent;
}

// Rounds over all journals, sync_every apart: syncs cost the same however little they carry. After
// a failure the next round comes by itself, whether more is delivered or not.
void Recorder::Threads::run_journals() {
  auto next = std::chrono::steady_clock::now();
  BackOff pauses;
  for (bool last = false; !last;) {
    std::size_t devices = 0;
    {
      std::unique_lock guard(mutex_);
      journal_.wait(guard, [&] { return work_; });
      journal_.wait_until(guard, next, [&] { return urgent_; });
      work_ = false;
      urgent_ = false;
      last = closing_;
      devices = lines_.size();
    }
    next = std::chrono::steady_clock::now();
    bool written = true;
    for (std::size_t i = 0; i < devices; ++i) written = write_journal(found(i), last) && written;
    if (written) {
      pauses.reset();
      next += options_.sync_every;
    } else {
      next += pauses.next();
      const std::lock_guard guard(mutex_);
      wake_journals(false);
    }
  }
}

// False when something of the device still waits.
bool Recorder::Threads::write_journal(Line& line, bool last) {
  int attempts = last ? kLastAttempts : 1;
  bool written = write_waiting(line);
  while (!written && --attempts > 0) written = write_waiting(line);
  if (last) line.journal.end_segment();
  const std::vector<std::uint64_t> ended = line.journal.take_ended();
  if (ended.empty()) return written;
  const std::lock_guard guard(mutex_);
  line.segments.insert(line.segments.end(), ended.begin(), ended.end());
  chunks_.notify_one();
  return written;
}

// Writes what waits of one device; false when something still does. After a failure nothing more is
// taken until a retry succeeds, so that no more than the queue's capacity ever waits twice.
bool Recorder::Threads::write_waiting(Line& line) {
  if (line.journal.pending() && !synced(line)) return false;
  std::deque<Block> blocks;
  {
    const std::lock_guard guard(mutex_);
    blocks = line.intake.take();
    room_.notify_all();
  }
  for (const Block& block : blocks) line.journal.append(block);
  return !line.journal.pending() || synced(line);
}

Result<void> Recorder::Threads::synced(Line& line) {
  const Result<void> done = line.journal.sync();
  const std::lock_guard guard(mutex_);
  line.journal_disk.take(done);
  if (done) {
    line.intake.acknowledge();
    line.acknowledged = line.journal.acknowledged();
  } else {
    room_.notify_all();
  }
  return done;
}

void Recorder::Threads::run_chunks() {
  std::unique_lock guard(mutex_);
  BackOff pauses;
  for (bool last = false; !last;) {
    const auto more = [&] { return journals_done_ || queued() > failed_; };
    if (failed_ == 0) {
      chunks_.wait(guard, more);
    } else {
      chunks_.wait_for(guard, pauses.next(), more);
    }
    last = journals_done_;
    for (int attempts = last ? kLastAttempts : 1; attempts > 0; --attempts) {
      failed_ = 0;
      // By number: a device may join while the lock is open.
      for (std::size_t i = 0; i < lines_.size(); ++i) seal_line(lines_[i], guard);
      if (failed_ == 0) break;
    }
    if (failed_ == 0) pauses.reset();
  }
}

std::size_t Recorder::Threads::queued() const {
  std::size_t sum = 0;
  for (const Line& line : lines_) sum += line.segments.size();
  return sum;
}

// Makes chunks of a device's segments, in order; those that fail stay.
void Recorder::Threads::seal_line(Line& line, std::unique_lock<std::mutex>& guard) {
  while (!line.segments.empty()) {
    const std::uint64_t number = line.segments.front();
    guard.unlock();
    auto sealed = seal_segment(files_, line.where, number, line.after);
    if (sealed && sealed->damage)
      line.damaged.push_back(damaged_segment(line.where, number, *sealed));
    if (sealed && sealed->entry) {
      line.after = sealed->entry->last_sequence();
      line.chunks.push_back(std::move(*sealed->entry));
    }
    guard.lock();
    if (!sealed) {
      line.chunk_disk.take(tl::make_unexpected(sealed.error()));
      failed_ += line.segments.size();
      return;
    }
    line.chunk_disk.take({});
    line.segments.pop_front();
  }
}

// Both threads have ended.
Result<void> Recorder::Threads::finish(const Conclusion& conclude) {
  const RecorderState state = this->state();
  if (conclude) manifests_.set_note(conclude(state));
  v1::ReplicateManifest& manifest = manifests_.own();
  bool leftover = false;
  std::vector<v1::RecordedDevice> devices;
  for (const Line& line : lines_) {
    devices.push_back(line.device);
    leftover = leftover || line.journal.leftover();
    manifest.mutable_chunks()->Add(line.chunks.begin(), line.chunks.end());
    for (const v1::DamagedFile& one : line.damaged) set_damaged(*manifest.mutable_damaged(), one);
  }
  const Result<void> closed = check_closed(state);
  if (manifest.has_note()) {
    settle_note(*manifest.mutable_note(), devices, state);
    for (const Line& line : lines_) {
      if (auto back = check_back(line); !back) interrupt(*manifest.mutable_note(), back.error());
    }
  }
  Result<void> written;
  for (int i = 0; i < kLastAttempts; ++i) {
    written = manifests_.end(files_, closed.has_value(), closed && !leftover);
    if (written) break;
  }
  return closed ? written : closed;
}

std::optional<v1::ReplicateNote> Recorder::Threads::note() const {
  if (!manifests_.own().has_note()) return std::nullopt;
  return manifests_.own().note();
}

// Every row is in a chunk. Error: the first device that lacks some, with its disk's error.
Result<void> Recorder::Threads::check_closed(const RecorderState& state) const {
  for (std::size_t i = 0; i < lines_.size(); ++i) {
    if (auto written = check_written(lines_[i].device, state, i); !written) return written;
  }
  for (const Line& line : lines_) {
    if (auto back = check_back(line); !back) return back;
    if (line.segments.empty()) continue;
    return fail(fmt::format("device {}: {} not in a chunk yet: {}", line.device.name(),
                            counted(line.segments.size(), "journal segment"),
                            line.chunk_disk.last_error().message));
  }
  return {};
}

// What was acknowledged came back from the journal.
Result<void> Recorder::Threads::check_back(const Line& line) {
  if (!line.segments.empty()) return {};  // not known yet
  std::uint64_t stored = 0;
  std::uint64_t in_chunks = 0;
  for (const StreamCounts& counts : line.intake.counts()) stored += counts.stored;
  for (const v1::ChunkEntry& chunk : line.chunks) in_chunks += chunk.samples();
  if (in_chunks >= stored) return {};
  return fail(fmt::format(
      "device {}: {} of {} stored samples did not come back from the journal{}; record to a better "
      "disk",
      line.device.name(), stored - in_chunks, stored,
      line.damaged.empty() ? "" : ": " + line.damaged.front().reason()));
}

}  // namespace imunoise::recording
