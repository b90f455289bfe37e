#pragma once

// The recorder's two threads, and what they share with those who hand blocks over.

#include <condition_variable>
#include <deque>
#include <mutex>
#include <set>
#include <thread>
#include <utility>

#include "recording/store/manifest/device_folder.h"
#include "recording/store/recorder/disk_log.h"
#include "recording/store/recorder/intake.h"
#include "recording/store/recorder/recorder.h"
#include "recording/store/recorder/recorder_manifests.h"

namespace imunoise::recording {

/// Of a device beside others, to whose names its own is added.
Result<void> check_new(const v1::RecordedDevice& device, std::set<std::string>& names);

class Recorder::Threads {
 public:
  Threads(FileSystem& files, std::filesystem::path folder, std::unique_ptr<FolderLock> lock,
          RecorderManifests manifests, const RecorderOptions& options);
  ~Threads() { (void)close({}); }
  Threads(const Threads&) = delete;
  Threads& operator=(const Threads&) = delete;

  Result<void> add_devices(const std::vector<v1::RecordedDevice>& devices);
  Result<void> run();
  // As the recorder's.
  Result<std::size_t> add(const v1::RecordedDevice& device);
  Result<bool> offer(std::size_t device, Block block);
  Result<bool> push(std::size_t device, const Block& block,
                    std::optional<std::chrono::milliseconds> patience);
  RecorderState state() const;
  const std::vector<std::string>& repaired() const { return manifests_.repaired(); }
  std::optional<v1::ReplicateNote> note() const;
  void annotate(const v1::ReplicateNote& note) { manifests_.set_note(note); }
  Result<void> close(const Conclusion& conclude);

 private:
  // All of one device. A deque of them: what it holds stays where it is, only finding it needs the
  // lock.
  struct Line {
    Line(const v1::RecordedDevice& of, DeviceFolder in, Journal to, Intake from)
        : device(of), where(std::move(in)), journal(std::move(to)), intake(std::move(from)) {}

    v1::RecordedDevice device;
    DeviceFolder where;
    Journal journal;                       // used by the journal thread
    Intake intake;                         // from here on guarded by the lock
    std::uint64_t acknowledged = 0;        // last block that is safe
    DiskLog journal_disk;                  // calls of the journal
    DiskLog chunk_disk;                    // calls that make chunks
    std::deque<std::uint64_t> segments;    // that grow no more
    std::uint64_t after = 0;               // last block in a chunk; used by the chunk thread
    std::vector<v1::DamagedFile> damaged;  // segments; used by the chunk thread
    std::vector<v1::ChunkEntry> chunks;    // made of segments; used by the chunk thread

    // What a failing disk did not take is tried again in the next round, and no sooner.
    bool presses() const { return intake.presses() && !journal_disk.trouble(); }
  };

  void append(const v1::RecordedDevice& device, DeviceFolder where, double first_share);
  Line& found(std::size_t device);
  Result<void> check(std::size_t device, const Block& block);

  void wake_journals(bool urgent);
  void run_journals();
  bool write_journal(Line& line, bool last);
  bool write_waiting(Line& line);
  Result<void> synced(Line& line);

  void run_chunks();
  std::size_t queued() const;
  void seal_line(Line& line, std::unique_lock<std::mutex>& guard);

  Result<void> finish(const Conclusion& conclude);
  Result<void> check_closed(const RecorderState& state) const;
  static Result<void> check_back(const Line& line);

  DiskCalls calls_;
  WatchedFiles files_;
  std::filesystem::path folder_;
  std::unique_ptr<FolderLock> lock_;
  RecorderManifests manifests_;
  const RecorderOptions options_;
  Result<void> outcome_;

  mutable std::mutex mutex_;  // guards what follows
  std::deque<Line> lines_;
  std::condition_variable journal_;
  std::condition_variable chunks_;
  std::condition_variable room_;
  std::size_t failed_ = 0;  // segments that could not be made chunks
  bool work_ = false;
  bool urgent_ = false;
  bool closing_ = false;
  bool journals_done_ = false;

  std::thread journal_thread_;
  std::thread chunk_thread_;
};

}  // namespace imunoise::recording
