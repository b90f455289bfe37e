// Days of a campaign in seconds: a clock that jumps, a recorder that writes manifests.

#include "daemon/acquire/campaign/campaign.h"

#include <gtest/gtest.h>
#include <unistd.h>

#include <algorithm>
#include <deque>
#include <fstream>
#include <functional>
#include <set>

#include "daemon/acquire/campaign/recordings.h"
#include "recording/store/manifest/manifest.h"
#include "tests/daemon/fake_recorder.h"

namespace imunoise::acquire {
namespace {

using namespace std::chrono_literals;
namespace fs = std::filesystem;
using testing::FakeRecorder, testing::files, testing::kBegin, testing::ManualClock;

class CampaignRun : public ::testing::Test {
 protected:
  CampaignRun()
      : folder_(fs::temp_directory_path() / ("imunoise_campaign_" + std::to_string(getpid()))) {
    fs::remove_all(folder_);
    campaign_.set_name("bench");
    campaign_.set_folder(folder_.string());
    campaign_.set_replicates(3);
    campaign_.set_length_s(3600.0);
    campaign_.set_settling_s(600.0);
    campaign_.set_pause_s(60.0);
  }
  ~CampaignRun() override { fs::remove_all(folder_); }

  // Runs a process from `begin` until it is finished or stopped; returns its last clock.
  Time run(Time begin, Time end = Time::max(), RunMode mode = RunMode::kScheduled) {
    ManualClock clock(begin);
    clock.stop_at(end);
    FakeRecorder recorder(clock);
    recorder.errors = errors_;
    recorder.knocks = knocks_;
    recorder.crash_at = crash_at_;
    recorder.leave_at = leave_at_;
    CampaignSurroundings with{clock, files(), recorder};
    with.leave = recorder.leave.get_token();
    with.calibrate = [&](const auto&, const fs::path& recording,
                         const Progress&) -> Result<std::string> {
      calibrated_.push_back(recording.filename().string());
      if (!calibration_error_.empty()) return fail(calibration_error_);
      return "2 of 2 channels have a model.";
    };
    with.publish = [&](const auto&, const fs::path& recording,
                       const Progress&) -> Result<std::string> {
      published_.push_back(recording.filename().string());
      if (leave_when_published_) recorder.leave.request_stop();
      return "imu0 drifts";
    };
    with.tell = [&](const v1::CampaignStatus& status) {
      told_.push_back(status);
      if (when_told_) when_told_(status);
    };
    run_campaign(campaign_, mode, with, clock.source().get_token());
    for (const ReplicateTask& task : recorder.tasks) {
      tasks_.push_back(task.folder.filename().string() + "/" + std::to_string(task.replicate));
    }
    return clock.now();
  }
  std::vector<v1::CampaignPhase> phases() const {
    std::vector<v1::CampaignPhase> out;
    for (const auto& status : told_) out.push_back(status.phase());
    return out;
  }
  bool was_told(const std::string& words) const {
    return std::any_of(told_.begin(), told_.end(), [&](const v1::CampaignStatus& status) {
      return status.reason().find(words) != std::string::npos;
    });
  }

  fs::path folder_;
  v1::Campaign campaign_;
  std::deque<std::string> errors_;
  std::set<std::size_t> knocks_;
  std::size_t crash_at_ = 0;
  std::size_t leave_at_ = 0;
  bool leave_when_published_ = false;
  std::string calibration_error_;
  std::vector<std::string> tasks_, calibrated_, published_;
  std::function<void(const v1::CampaignStatus&)> when_told_;
  int pauses_seen_ = 0;
  std::vector<v1::CampaignStatus> told_;
};

using Texts = std::vector<std::string>;

TEST_F(CampaignRun, GoesThroughItsPhasesOnce) {
  const Time end = run(kBegin);
  EXPECT_EQ(tasks_,
            (Texts{"2026-03-01T001000Z/1", "2026-03-01T001000Z/2", "2026-03-01T001000Z/3"}));
  EXPECT_EQ(calibrated_, Texts{"2026-03-01T001000Z"});
  EXPECT_EQ(published_, Texts{"2026-03-01T001000Z"});
  EXPECT_EQ(end, kBegin + 10min + 3h + 2min);
  using v1::recording, v1::pausing;
  EXPECT_EQ(phases(), (std::vector<v1::CampaignPhase>{v1::settling, recording, pausing, recording,
                                                      pausing, recording, v1::calibrating,
                                                      v1::publishing, v1::finished}));
  EXPECT_EQ(told_[7].reason(), "2 of 2 channels have a model.");
  EXPECT_EQ(told_[8].reason(), "imu0 drifts");
  EXPECT_EQ(told_[3].replicate(), 2U);
  EXPECT_EQ(told_[3].replicates(), 3U);
}

TEST_F(CampaignRun, LeavesOnceTheReplicateIsRecorded) {
  leave_at_ = 2;
  const Time end = run(kBegin);
  EXPECT_EQ(end, kBegin + 10min + 2h + 1min) << "no pause after it";
  const auto newest = newest_recording(files(), campaign_, SystemClock()).value();
  ASSERT_EQ(newest->state.notes.size(), 2U);
  EXPECT_EQ(newest->state.notes[1].state(), v1::complete);
  EXPECT_TRUE(calibrated_.empty());
}

TEST_F(CampaignRun, LeavesAtOnceWhenNothingIsRecorded) {
  campaign_.mutable_schedule()->set_every_s(6 * 3600.0);
  leave_when_published_ = true;
  EXPECT_EQ(run(kBegin), kBegin + 10min + 3h + 2min) << "it does not wait for the next recording";
  EXPECT_EQ(tasks_.size(), 3U);
}

TEST_F(CampaignRun, WaitsWhileAnotherProcessRecordsIntoItsFolder) {
  ASSERT_TRUE(recording::make_folders(files(), campaign_.folder()));
  auto other = files().lock(campaign_.folder());
  ASSERT_TRUE(other);
  when_told_ = [&](const v1::CampaignStatus& status) {
    EXPECT_TRUE(tasks_.empty());
    if (status.phase() == v1::held_up) other->reset();
  };
  run(kBegin);
  EXPECT_TRUE(was_told("another process is recording into it"));
  ASSERT_GE(phases().size(), 2U);
  EXPECT_EQ(phases()[1], v1::held_up) << "it does not say that it records";
  EXPECT_EQ(tasks_.size(), 3U);
}

TEST_F(CampaignRun, AFinishedOneDoesNotRecordAgain) {
  run(kBegin);
  tasks_.clear();
  run(kBegin + 1000h);
  EXPECT_TRUE(tasks_.empty());
  EXPECT_EQ(calibrated_.size(), 2U) << "after a restart the hooks are called again";
}

TEST_F(CampaignRun, ThirtyDaysEverySixHours) {
  campaign_.mutable_schedule()->set_every_s(6 * 3600.0);
  run(kBegin, kBegin + std::chrono::days(30));
  ASSERT_EQ(calibrated_.size(), 120U);
  EXPECT_EQ(tasks_.size(), 360U);
  EXPECT_EQ(calibrated_[0], "2026-03-01T001000Z");
  EXPECT_EQ(calibrated_[1], "2026-03-01T061000Z");
  EXPECT_EQ(calibrated_[119], "2026-03-30T181000Z") << "no drift";
}

// Three replicates take longer than there is from one recording to the next.
TEST_F(CampaignRun, ARecordingThatIsNeverCompleteIsTold) {
  campaign_.mutable_schedule()->set_every_s(2 * 3600.0);
  campaign_.mutable_retention()->set_recordings(2);
  run(kBegin, kBegin + 24h);
  EXPECT_TRUE(calibrated_.empty());
  EXPECT_TRUE(was_told("stays unfinished with 2 of 3 replicates"));
  const auto kept = std::distance(fs::directory_iterator(folder_), fs::directory_iterator());
  EXPECT_LE(kept, 3) << "retention holds for what is left unfinished, too";
}

TEST_F(CampaignRun, ARestartGoesOnWhereTheManifestSaysItWas) {
  crash_at_ = 2;
  run(kBegin);
  EXPECT_EQ(tasks_.size(), 2U);
  crash_at_ = 0;
  run(kBegin + 10h);
  EXPECT_EQ(tasks_, (Texts{"2026-03-01T001000Z/1", "2026-03-01T001000Z/2", "2026-03-01T001000Z/3",
                           "2026-03-01T001000Z/4"}));
  EXPECT_EQ(calibrated_, Texts{"2026-03-01T001000Z"});
  const auto newest = newest_recording(files(), campaign_, SystemClock()).value();
  ASSERT_TRUE(newest.has_value());
  EXPECT_EQ(newest->state.notes[1].state(), v1::interrupted);
  EXPECT_EQ(good_replicates(campaign_, newest->state.notes), 3U);
}

TEST_F(CampaignRun, EveryCrashOfAWeekIsGotOver) {
  campaign_.mutable_schedule()->set_every_s(6 * 3600.0);
  const Time end = kBegin + std::chrono::days(7);
  crash_at_ = 5;
  Time now = kBegin;
  while (now < end) now = run(now, end) + 1min;
  const auto listed = files().list(folder_).value();
  EXPECT_EQ(listed.size(), 28U);
  std::size_t complete = 0;
  for (const std::string& name : listed) {
    const auto manifest = recording::read_manifest(files(), folder_ / name).value();
    const auto& notes = manifest->replicates();
    complete += good_replicates(campaign_, {notes.begin(), notes.end()}) == 3U ? 1U : 0U;
  }
  EXPECT_EQ(complete, 28U);
  EXPECT_EQ(std::set<std::string>(calibrated_.begin(), calibrated_.end()).size(), 28U);
}

TEST_F(CampaignRun, WhatGoesWrongIsTriedAgainLaterAndLater) {
  errors_ = {"no device is there: imu0: unplugged", "no device is there: imu0: unplugged",
             "no device is there: imu0: unplugged"};
  const Time end = run(kBegin);
  EXPECT_EQ(tasks_.size(), 6U);
  EXPECT_TRUE(was_told("unplugged"));
  EXPECT_EQ(end, kBegin + 10min + 3h + 2min + 5s + 10s + 20s);
  EXPECT_EQ(calibrated_.size(), 1U);
}

TEST_F(CampaignRun, RepeatsAReplicateThatWasDisturbed) {
  campaign_.mutable_stillness()->set_repeat_disturbed(true);
  campaign_.mutable_stillness()->set_repeats(1);
  knocks_ = {2};
  run(kBegin);
  EXPECT_EQ(tasks_.size(), 4U);
  EXPECT_TRUE(was_told("the sensors moved"));
}

TEST_F(CampaignRun, AFailedCalibrationIsToldAndStopsNothing) {
  campaign_.mutable_schedule()->set_every_s(6 * 3600.0);
  calibration_error_ = "the model does not fit";
  run(kBegin, kBegin + 13h);
  EXPECT_TRUE(was_told("calibration: the model does not fit"));
  EXPECT_EQ(published_.size(), 2U);
}

TEST_F(CampaignRun, OnceResumesOrMakesOneMore) {
  crash_at_ = 2;
  run(kBegin, Time::max(), RunMode::kOnce);
  crash_at_ = 0;
  run(kBegin + 5h, Time::max(), RunMode::kOnce);
  EXPECT_EQ(calibrated_, Texts{"2026-03-01T001000Z"});
  run(kBegin + 24h, Time::max(), RunMode::kOnce);
  EXPECT_EQ(calibrated_.back(), "2026-03-02T001000Z");
  EXPECT_EQ(tasks_.size(), 2U + 2U + 3U);
}

TEST_F(CampaignRun, KeepsWhatRetentionSays) {
  campaign_.mutable_schedule()->set_every_s(6 * 3600.0);
  campaign_.mutable_retention()->set_recordings(3);
  fs::create_directories(folder_ / "2020-01-01T000000Z");  // not ours: without a manifest
  fs::create_directories(folder_ / "notes");
  run(kBegin, kBegin + std::chrono::days(2));
  EXPECT_EQ(files().list(folder_).value(),
            (Texts{"2020-01-01T000000Z/", "2026-03-02T061000Z/", "2026-03-02T121000Z/",
                   "2026-03-02T181000Z/", "notes/"}));
  campaign_.mutable_retention()->clear_recordings();
  campaign_.mutable_retention()->set_age_s(3600.0);
  const ManualClock later(kBegin + 1000h);
  ASSERT_TRUE(tidy_recordings(files(), campaign_, later).has_value());
  EXPECT_EQ(files().list(folder_).value(),
            (Texts{"2020-01-01T000000Z/", "2026-03-02T181000Z/", "notes/"}))
      << "the newest stays";
}

TEST_F(CampaignRun, ARecordingThatIsGoneIsTold) {
  when_told_ = [&](const v1::CampaignStatus& status) {
    if (status.phase() == v1::pausing && pauses_seen_++ == 0) fs::remove_all(folder_);
  };
  run(kBegin);
  const auto told = std::count_if(told_.begin(), told_.end(), [](const auto& status) {
    return status.reason().find("/2026-03-01T001000Z not found") != std::string::npos;
  });
  EXPECT_EQ(told, 1);
  EXPECT_EQ(tasks_.size(), 4U) << "another recording is made, whole";
}

TEST_F(CampaignRun, RecordingsOfAnotherCampaignAreLeftAlone) {
  run(kBegin);
  campaign_.set_name("other");
  const ManualClock later(kBegin + 1000h);
  EXPECT_FALSE(newest_recording(files(), campaign_, later).value().has_value());
  campaign_.mutable_retention()->set_age_s(1.0);
  EXPECT_TRUE(tidy_recordings(files(), campaign_, later).value().removed.empty());
}

TEST_F(CampaignRun, ADamagedManifestHoldsItUpAndNamesTheWayOut) {
  run(kBegin);
  std::ofstream(folder_ / "2026-03-01T001000Z" / recording::kManifestName) << "{";
  run(kBegin + 5h, kBegin + 6h);
  EXPECT_TRUE(was_told("imunoise verify --repair"));
}

TEST(RecordingName, IsTheInverseOfStartOf) {
  for (const char* const name :
       {"2026-03-01T060000Z", "1999-12-31T235959Z", "2024-02-29T000001Z"}) {
    EXPECT_EQ(recording_name(start_of(name).value()), name);
  }
  for (const char* const name : {"2026-02-30T060000Z", "2026-03-01T240000Z", "2026-03-01 060000Z",
                                 "2026-03-01T060000", "replicate-1", ""}) {
    EXPECT_FALSE(start_of(name).has_value()) << name;
  }
}

}  // namespace
}  // namespace imunoise::acquire
