#pragma once

// Replicates without devices: their time passes, and their manifests come about.

#include <gtest/gtest.h>

#include <deque>
#include <filesystem>
#include <set>
#include <stop_token>
#include <string>
#include <utility>
#include <vector>

#include "daemon/acquire/campaign/campaign.h"
#include "daemon/acquire/campaign/recordings.h"
#include "daemon/acquire/start_stamp.h"
#include "recording/store/format/layout.h"
#include "recording/store/manifest/manifest.h"
#include "tests/daemon/manual_clock.h"
#include "tests/recording/store/whole_manifest.h"

namespace imunoise::testing {

inline const acquire::Time kBegin =
    acquire::Time(std::chrono::sys_days(std::chrono::year(2026) / 3 / 1));

inline recording::FileSystem& files() { return recording::posix_file_system(); }

// Writes what record_replicate() writes into the manifest, and lets the time pass.
class FakeRecorder : public acquire::ReplicateRecorder {
 public:
  explicit FakeRecorder(ManualClock& clock) : clock_(clock) {}

  Result<v1::ReplicateNote> record(const v1::Campaign& campaign, const acquire::ReplicateTask& task,
                                   const Progress& progress) override {
    tasks.push_back(task);
    if (!errors.empty()) {
      const std::string error = errors.front();
      errors.pop_front();
      return fail(error);
    }
    v1::ReplicateNote note;
    note.set_replicate(task.replicate);
    acquire::stamp_start(note, clock_);
    note.set_state(v1::open);
    write(campaign, task, note);
    if (tasks.size() == crash_at) {
      clock_.source().request_stop();
      return note;  // as a process does that is killed: the manifest stays open
    }
    if (tasks.size() == leave_at) leave.request_stop();
    clock_.pass(std::chrono::nanoseconds(static_cast<std::int64_t>(campaign.length_s() * 1e9)));
    clock_.leap(std::exchange(leap, {}));
    note.set_state(progress.stopped() ? v1::interrupted : v1::complete);
    if (knocks.contains(tasks.size())) note.add_disturbances()->set_begin_ns(note.started_ns());
    write(campaign, task, note);
    return note;
  }

  std::vector<acquire::ReplicateTask> tasks;
  std::deque<std::string> errors;
  std::set<std::size_t> knocks;  // which of the tasks, from 1
  std::size_t crash_at = 0;
  std::size_t leave_at = 0;
  std::stop_source leave;
  std::chrono::nanoseconds leap = {};  // of the time of day, during the next replicate

 private:
  static void write(const v1::Campaign& campaign, const acquire::ReplicateTask& task,
                    const v1::ReplicateNote& note) {
    std::filesystem::create_directories(task.folder / recording::replicate_folder(task.replicate));
    v1::Manifest manifest =
        recording::read_manifest(files(), task.folder).value().value_or(v1::Manifest());
    manifest.set_campaign(campaign.name());
    manifest.set_closed(note.state() != v1::open);
    for (v1::ReplicateNote& one : *manifest.mutable_replicates())
      recording::end_open_replicate(one, "");
    recording::set_note(manifest, note);
    ASSERT_TRUE(recording::write_manifest(files(), task.folder, manifest).has_value());
  }

  ManualClock& clock_;
};

}  // namespace imunoise::testing
