#pragma once

#include <algorithm>

#include "daemon/acquire/campaign/campaign.h"
#include "daemon/acquire/campaign/campaign_recorder.h"
#include "daemon/acquire/clock.h"
#include "tests/recording/store/fake_disk.h"

namespace imunoise::testing {

/// Whoever waits, for the schedule or after trouble, has waited already.
class HastyClock : public acquire::SystemClock {
 public:
  acquire::Time now() const override { return SystemClock::now() + skipped_; }
  std::chrono::nanoseconds since_boot() const override {
    return SystemClock::since_boot() + skipped_;
  }
  bool wait_until(acquire::Time time, const std::stop_token& stop) override {
    skipped_ += std::max<std::chrono::nanoseconds>(time - now(), std::chrono::nanoseconds(0));
    return !stop.stop_requested();
  }

 private:
  std::chrono::nanoseconds skipped_{0};
};

/// Runs one recording of a campaign, without waiting for anything but samples. Whether it came to
/// its end by itself.
inline bool run_once(const v1::Campaign& campaign, const drivers::Drivers& drivers,
                     recording::FakeDisk& disk) {
  HastyClock clock;
  acquire::CampaignRecorder recorder(disk, drivers, {});
  acquire::CampaignSurroundings with{clock, disk, recorder};
  std::stop_source enough;
  int told = 0;
  bool finished = false;
  with.tell = [&](const v1::CampaignStatus& status) {
    finished = status.phase() == v1::finished;
    if (++told > 100) enough.request_stop();
  };
  acquire::run_campaign(campaign, acquire::RunMode::kOnce, with, enough.get_token());
  return finished;
}

}  // namespace imunoise::testing
