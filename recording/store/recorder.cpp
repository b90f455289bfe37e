#include "recording/store/recorder.h"

#include <fmt/core.h>

#include <condition_variable>
#include <mutex>
#include <set>
#include <thread>
#include <utility>

#include "recording/store/device_folder.h"
#include "recording/store/format_version.h"
#include "recording/store/intake.h"
#include "recording/store/recover.h"

namespace imunoise::recording {
namespace {

// Segments of one device that grow no more, and the chunks made of them. Used by the chunk thread.
struct ChunkLine {
  DeviceFolder where;
  std::deque<std::uint64_t> segments;  // guarded by the recorder's lock
  std::uint64_t after = 0;             // last block in a chunk
  std::vector<v1::ChunkEntry> chunks;
};

// Recovers what is there and adds the plan's devices. Their chunks come when the recorder closes.
Result<v1::Manifest> open_manifest(FileSystem& files, const std::filesystem::path& folder,
                                   const RecordingPlan& plan) {
  auto recovered = recover_recording(files, folder);
  if (!recovered) return tl::make_unexpected(recovered.error());
  v1::Manifest manifest = std::move(recovered->manifest);
  if (manifest.started_ns() == 0) manifest.set_started_ns(plan.started_ns);
  if (manifest.campaign().empty()) manifest.set_campaign(plan.campaign);
  for (const v1::RecordedDevice& device : plan.devices) add_device(manifest, device);
  end_open_replicates(manifest);
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

// Of a device beside others, to whose names its own is added.
Result<void> check_new(const v1::RecordedDevice& device, std::set<std::string>& names) {
  if (auto good = check_device(device); !good)
    return fail(fmt::format("device {}: {}", device.name(), good.error().message));
  if (!names.insert(device.name()).second)
    return fail(fmt::format("two devices are named '{}'; rename one", device.name()));
  return {};
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

class Recorder::Threads {
 public:
  Threads(FileSystem& files, std::filesystem::path folder, std::unique_ptr<FolderLock> lock,
          v1::Manifest manifest, std::uint32_t replicate, const RecorderOptions& options)
      : files_(files),
        folder_(std::move(folder)),
        lock_(std::move(lock)),
        manifest_(std::move(manifest)),
        replicate_(replicate),
        options_(options) {}

  ~Threads() { (void)close(); }

  Result<void> add_devices(const std::vector<v1::RecordedDevice>& devices) {
    for (std::size_t i = 0; i < devices.size(); ++i) {
      auto where = make_device_folder(files_, folder_, replicate_, devices[i].name());
      if (!where) return tl::make_unexpected(where.error());
      const double share = static_cast<double>(i + 1) / static_cast<double>(devices.size());
      append(devices[i], std::move(*where), share);
    }
    return {};
  }

  Result<std::size_t> add(const v1::RecordedDevice& device) {
    std::set<std::string> names;  // only this function adds to them, once it records
    for (const v1::RecordedDevice& one : devices_) names.insert(one.name());
    if (auto good = check_new(device, names); !good) return tl::make_unexpected(good.error());
    auto where = make_device_folder(files_, folder_, replicate_, device.name());
    if (!where) return tl::make_unexpected(where.error());
    add_device(manifest_, device);
    if (auto done = write_manifest(files_, folder_, manifest_); !done)
      return tl::make_unexpected(done.error());
    append(device, std::move(*where), 1.0);
    return devices_.size() - 1;
  }

  Result<void> run() {
    if (auto done = write_manifest(files_, folder_, manifest_); !done) return done;
    journal_thread_ = std::thread([this] { run_journals(); });
    chunk_thread_ = std::thread([this] { run_chunks(); });
    return {};
  }

  Result<bool> offer(std::size_t device, Block block) {
    if (auto good = check(device, block); !good) return tl::make_unexpected(good.error());
    const std::lock_guard guard(mutex_);
    const bool room = intakes_[device].has_room(block.rows.size());
    if (room) {
      intakes_[device].add(std::move(block));
    } else {
      intakes_[device].refuse(block);
    }
    wake_journals(intakes_[device].presses());
    return room;
  }

  Result<void> push(std::size_t device, const Block& block) {
    if (auto good = check(device, block); !good) return good;
    std::unique_lock guard(mutex_);
    const std::uint64_t failures = failures_;
    const auto room = [&] { return intakes_[device].has_room(block.rows.size()); };
    if (!room()) wake_journals(true);
    room_.wait(guard, [&] { return room() || failures_ != failures; });
    if (!room()) return tl::make_unexpected(*trouble_);
    intakes_[device].add(block);
    wake_journals(intakes_[device].presses());
    return {};
  }

  RecorderState state() const {
    const std::lock_guard guard(mutex_);
    RecorderState out;
    for (const Intake& intake : intakes_) out.counts.push_back(intake.counts());
    out.acknowledged = acknowledged_;
    out.trouble = trouble_;
    return out;
  }

  void annotate(const v1::ReplicateNote& note) { set_note(manifest_, note); }

  Result<void> close() {
    if (!journal_thread_.joinable()) return outcome_;
    {
      const std::lock_guard guard(mutex_);
      for (Intake& intake : intakes_) intake.flush_refusals();
      closing_ = true;
      wake_journals(true);
    }
    journal_thread_.join();
    {
      const std::lock_guard guard(mutex_);
      journals_done_ = true;
      for (Intake& intake : intakes_) intake.give_up();
    }
    chunks_.notify_one();
    chunk_thread_.join();
    outcome_ = finish();
    lock_.reset();
    return outcome_;
  }

 private:
  // `first_share` of the limits ends its first segment.
  void append(const v1::RecordedDevice& device, DeviceFolder where, double first_share) {
    const std::lock_guard guard(mutex_);
    devices_.push_back(device);
    intakes_.emplace_back(device, options_.waiting_rows);
    journals_.emplace_back(files_, where.path(), device, JournalPlace{replicate_, 1, 1},
                           options_.segments, first_share);
    lines_.push_back({std::move(where), {}, 0, {}});
    acknowledged_.push_back(0);
  }

  // What a deque holds stays where it is; only finding it needs the lock.
  template <class Element>
  Element& found(std::deque<Element>& in, std::size_t device) {
    const std::lock_guard guard(mutex_);
    return in[device];
  }

  Result<void> check(std::size_t device, const Block& block) {
    const v1::RecordedDevice& of = found(devices_, device);
    auto good = check_block(of, block);
    if (good) return good;
    return fail(fmt::format("device {}: {}", of.name(), good.error().message));
  }

  // The lock is held. What is not urgent waits for the next round.
  void wake_journals(bool urgent) {
    if (!work_ || (urgent && !urgent_)) journal_.notify_one();
    work_ = true;
    urgent_ = urgent_ || urgent;
  }

  // Rounds over all journals, sync_every apart: syncs cost the same however little they carry.
  void run_journals() {
    auto next = std::chrono::steady_clock::now();
    for (bool last = false; !last;) {
      std::size_t devices = 0;
      {
        std::unique_lock guard(mutex_);
        journal_.wait(guard, [&] { return work_; });
        journal_.wait_until(guard, next, [&] { return urgent_; });
        work_ = false;
        urgent_ = false;
        last = closing_;
        devices = journals_.size();
      }
      next = std::chrono::steady_clock::now() + options_.sync_every;
      for (std::size_t i = 0; i < devices; ++i) write_journal(i, last);
    }
  }

  // Writes what waits of one device. After a failure nothing more is taken until a retry succeeds,
  // so that no more than the queue's capacity ever waits twice.
  void write_journal(std::size_t device, bool last) {
    Journal& journal = found(journals_, device);
    Result<void> done;
    if (journal.pending()) done = synced(journal, device);
    if (done) {
      std::deque<Block> blocks;
      {
        const std::lock_guard guard(mutex_);
        blocks = intakes_[device].take();
        room_.notify_all();
      }
      for (const Block& block : blocks) journal.append(block);
      if (journal.pending()) done = synced(journal, device);
    }
    if (last) journal.end_segment();
    const std::vector<std::uint64_t> ended = journal.take_ended();
    if (ended.empty()) return;
    const std::lock_guard guard(mutex_);
    lines_[device].segments.insert(lines_[device].segments.end(), ended.begin(), ended.end());
    chunks_.notify_one();
  }

  Result<void> synced(Journal& journal, std::size_t device) {
    const Result<void> done = journal.sync();
    const std::lock_guard guard(mutex_);
    if (done) {
      intakes_[device].acknowledge();
      acknowledged_[device] = journal.acknowledged();
      trouble_.reset();
    } else {
      trouble_ = done.error();
      ++failures_;
      room_.notify_all();
    }
    return done;
  }

  void run_chunks() {
    std::unique_lock guard(mutex_);
    for (bool last = false; !last;) {
      const std::size_t seen = queued();
      if (seen == 0 || failed_ == seen) {  // what failed is tried again with the next segment
        chunks_.wait(guard, [&] { return journals_done_ || queued() > failed_; });
      }
      last = journals_done_;
      failed_ = 0;
      for (std::size_t i = 0; i < lines_.size(); ++i) seal_line(lines_[i], guard);
    }
  }

  std::size_t queued() const {
    std::size_t sum = 0;
    for (const ChunkLine& line : lines_) sum += line.segments.size();
    return sum;
  }

  // Makes chunks of a device's segments, in order; those that fail stay.
  void seal_line(ChunkLine& line, std::unique_lock<std::mutex>& guard) {
    while (!line.segments.empty()) {
      const std::uint64_t number = line.segments.front();
      guard.unlock();
      auto sealed = seal_segment(files_, line.where, number, line.after);
      if (sealed && sealed->entry) {
        line.after = sealed->entry->last_sequence();
        line.chunks.push_back(std::move(*sealed->entry));
      }
      guard.lock();
      if (!sealed) {
        trouble_ = sealed.error();
        failed_ += line.segments.size();
        return;
      }
      line.segments.pop_front();
    }
  }

  // Both threads have ended.
  Result<void> finish() {
    bool complete = true;
    for (std::size_t i = 0; i < lines_.size(); ++i) {
      for (const v1::ChunkEntry& chunk : lines_[i].chunks) *manifest_.add_chunks() = chunk;
      complete = complete && lines_[i].segments.empty() && !journals_[i].pending();
    }
    if (!complete && trouble_) return tl::make_unexpected(*trouble_);
    manifest_.set_closed(true);
    return write_manifest(files_, folder_, manifest_);
  }

  FileSystem& files_;
  std::filesystem::path folder_;
  std::unique_ptr<FolderLock> lock_;
  v1::Manifest manifest_;
  const std::uint32_t replicate_;
  const RecorderOptions options_;
  Result<void> outcome_;

  mutable std::mutex mutex_;  // guards what follows
  std::deque<v1::RecordedDevice> devices_;
  std::deque<Journal> journals_;  // each used by the journal thread
  std::condition_variable journal_;
  std::condition_variable chunks_;
  std::condition_variable room_;
  std::vector<Intake> intakes_;
  std::deque<ChunkLine> lines_;
  std::vector<std::uint64_t> acknowledged_;
  std::optional<Error> trouble_;
  std::uint64_t failures_ = 0;  // of syncs
  std::size_t failed_ = 0;      // segments that could not be made chunks
  bool work_ = false;
  bool urgent_ = false;
  bool closing_ = false;
  bool journals_done_ = false;

  std::thread journal_thread_;
  std::thread chunk_thread_;
};

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
  return threads_->push(device, block);
}

RecorderState Recorder::state() const { return threads_->state(); }

void Recorder::annotate(const v1::ReplicateNote& note) { threads_->annotate(note); }

Result<std::size_t> Recorder::add(const v1::RecordedDevice& device) {
  return threads_->add(device);
}

Result<void> Recorder::close() { return threads_->close(); }

}  // namespace imunoise::recording
