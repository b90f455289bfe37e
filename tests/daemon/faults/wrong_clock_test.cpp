// Campaigns on a machine whose clock is wrong, and is set.

#include <gtest/gtest.h>
#include <unistd.h>

#include <algorithm>
#include <filesystem>

#include "daemon/acquire/campaign/campaign.h"
#include "daemon/acquire/campaign/recordings.h"
#include "recording/store/manifest/manifest.h"
#include "tests/daemon/fake_recorder.h"

namespace imunoise::acquire {
namespace {

using namespace std::chrono_literals;
namespace fs = std::filesystem;
using testing::FakeRecorder, testing::files, testing::kBegin, testing::ManualClock;

constexpr std::chrono::nanoseconds kTenYears = std::chrono::days(3652);

class WrongClock : public ::testing::Test {
 protected:
  WrongClock()
      : folder_(fs::temp_directory_path() / ("imunoise_clock_" + std::to_string(getpid()))),
        clock_(kBegin),
        recorder_(clock_) {
    fs::remove_all(folder_);
    campaign_.set_name("bench");
    campaign_.set_folder(folder_.string());
    campaign_.set_replicates(1);
    campaign_.set_length_s(600.0);
    campaign_.mutable_schedule()->set_every_s(3600.0);
  }
  ~WrongClock() override { fs::remove_all(folder_); }

  // A process that runs for so long, by the time since boot.
  void run(std::chrono::nanoseconds time) {
    clock_.stop_after(time);
    CampaignSurroundings with{clock_, files(), recorder_};
    with.tell = [&](const v1::CampaignStatus& status) { told_.push_back(status); };
    run_campaign(campaign_, RunMode::kScheduled, with, clock_.source().get_token());
  }
  void restart_machine() { clock_.set_boot("another boot", 30s); }
  std::vector<std::string> on_disk() const {
    std::vector<std::string> out;
    for (const auto& one : fs::directory_iterator(folder_))
      out.push_back(one.path().filename().string());
    std::sort(out.begin(), out.end());
    return out;
  }
  bool was_told(const std::string& words) const {
    return std::any_of(told_.begin(), told_.end(), [&](const v1::CampaignStatus& status) {
      return status.reason().find(words) != std::string::npos;
    });
  }

  fs::path folder_;
  v1::Campaign campaign_;
  ManualClock clock_;
  FakeRecorder recorder_;
  std::vector<v1::CampaignStatus> told_;
};

TEST_F(WrongClock, DeletesNothingThatIsYoung) {
  campaign_.mutable_retention()->set_age_s(30 * 86400.0);
  run(150min);
  ASSERT_EQ(on_disk().size(), 3U);
  clock_.leap(kTenYears);
  run(2h);
  EXPECT_EQ(on_disk().size(), 5U) << "it looks ten years old, and the machine runs for hours";
}

TEST_F(WrongClock, DeletesNothingWhileNobodyKeepsItRight) {
  campaign_.mutable_retention()->set_age_s(30 * 86400.0);
  run(150min);
  restart_machine();
  clock_.leap(kTenYears);
  clock_.set_synchronised(false);
  run(30min);
  EXPECT_EQ(on_disk().size(), 4U);
  EXPECT_TRUE(was_told("look older than retention.age"));
  clock_.set_synchronised(true);
  run(1h);
  EXPECT_EQ(on_disk().size(), 2U) << "now it is known that they are old";
}

TEST_F(WrongClock, WhatWasRecordedUnderAnUnknownTimeDoesNotAge) {
  campaign_.mutable_retention()->set_age_s(30 * 86400.0);
  clock_.leap(-kTenYears);
  clock_.set_synchronised(false);
  run(30min);
  restart_machine();
  clock_.leap(kTenYears);
  clock_.set_synchronised(true);
  run(90min);
  EXPECT_EQ(on_disk().size(), 3U);
}

TEST_F(WrongClock, WhatThisRunOfTheMachineRecordedAgesByItsOwnTime) {
  campaign_.mutable_retention()->set_age_s(86400.0);
  run(30h);
  const auto kept = on_disk();
  EXPECT_GE(kept.size(), 24U);
  EXPECT_LE(kept.size(), 26U);
}

TEST_F(WrongClock, TheNewestBySetClocksStaysWhereRecordingsAreCounted) {
  campaign_.mutable_retention()->set_recordings(2);
  clock_.leap(kTenYears);
  run(150min);
  clock_.leap(-kTenYears);
  restart_machine();
  run(150min);
  EXPECT_EQ(on_disk(), (std::vector<std::string>{"2026-03-01T033000Z", "2026-03-01T043000Z"}))
      << "those of 2036 were made before";
}

TEST_F(WrongClock, ACorrectedClockIsToldAndTheScheduleGoesOn) {
  clock_.leap(kTenYears);
  clock_.leap_at(kBegin + kTenYears + 30min, -kTenYears);
  run(150min);
  EXPECT_EQ(on_disk(), (std::vector<std::string>{"2026-03-01T010000Z", "2026-03-01T020000Z",
                                                 "2036-02-29T000000Z"}));
  EXPECT_TRUE(was_told("set back by"));
}

TEST_F(WrongClock, TheScheduleGoesOnAfterARestartOfTheProgram) {
  clock_.leap(kTenYears);
  run(30min);
  clock_.leap(-kTenYears);
  run(2h);
  EXPECT_EQ(on_disk(), (std::vector<std::string>{"2026-03-01T010000Z", "2026-03-01T020000Z",
                                                 "2036-02-29T000000Z"}));
}

TEST_F(WrongClock, TheScheduleGoesOnAfterARestartOfTheMachine) {
  clock_.leap(kTenYears);
  run(30min);
  clock_.leap(-kTenYears);
  restart_machine();
  run(90min);
  EXPECT_EQ(on_disk().size(), 3U);
  EXPECT_EQ(on_disk().back(), "2036-02-29T000000Z");
}

TEST_F(WrongClock, ARecordingGoesOnWhenItsClockIsSet) {
  campaign_.set_replicates(3);
  campaign_.set_pause_s(60.0);
  for (const auto leap : {1h, -1h}) {
    fs::remove_all(folder_);
    recorder_.leap = leap;
    run(35min);
    ASSERT_EQ(on_disk().size(), 1U);
    EXPECT_EQ(recording::read_manifest(files(), folder_ / on_disk()[0])->value().replicates_size(),
              3)
        << "replicates of one recording belong together, and pauses are no longer";
    EXPECT_TRUE(was_told(leap > 0h ? "set forward by 1 h" : "set back by 1 h"));
  }
}

}  // namespace
}  // namespace imunoise::acquire
