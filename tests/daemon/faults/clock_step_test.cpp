// The time of day is set while a replicate is recorded.

#include <chrono>
#include <mutex>
#include <thread>

#include "daemon/acquire/record_replicate.h"
#include "recording/store/manifest/manifest.h"
#include "recording/store/verify/verify.h"
#include "tests/daemon/faults/set_clock.h"
#include "tests/daemon/whims.h"

namespace imunoise::acquire {
namespace {

using namespace std::chrono_literals;

class ClockStep : public testing::Whims, public ::testing::WithParamInterface<std::int64_t> {
 protected:
  ~ClockStep() override { set_by_s = 0; }
};

TEST_P(ClockStep, LosesNothingAndIsNoted) {
  tell("a", "here");
  ReplicatePlan plan;
  plan.folder = folder_ / "recording";
  plan.duration = 600ms;
  plan.devices = {{"a",
                   *drivers().find("whims").value(),
                   {{"file", word_of("a").string()}, {"stamped", "true"}}}};
  std::mutex telling;
  std::string told;
  const std::jthread setter([] {
    std::this_thread::sleep_for(250ms);
    set_by_s = GetParam();
  });
  const auto before = std::chrono::system_clock::now().time_since_epoch();
  const auto done = record_replicate(recording::posix_file_system(), plan,
                                     [&](const std::string&, std::string_view text) {
                                       const std::lock_guard lock(telling);
                                       told += text;
                                     });
  ASSERT_TRUE(done.has_value()) << done.error().message;
  const v1::ReplicateNote& note = done->note;
  EXPECT_EQ(note.state(), v1::complete);
  EXPECT_NEAR(static_cast<double>(note.started_ns() - before.count()) * 1e-9, 0.0, 1.0);
  EXPECT_NEAR(static_cast<double>(note.ended_ns() - note.started_ns()) * 1e-9, 0.6, 1.0);
  ASSERT_EQ(note.clock_steps_size(), 1);
  EXPECT_NEAR(note.clock_steps(0).step_s(), static_cast<double>(GetParam()), 0.05);
  EXPECT_NE(told.find("the clock of this machine was set"), std::string::npos) << told;
  const auto report =
      recording::verify_recording(recording::posix_file_system(), plan.folder, false);
  ASSERT_TRUE(report->sound()) << report->ShortDebugString();
  EXPECT_EQ(report->streams(0).lost(), 0U) << report->ShortDebugString();
  EXPECT_EQ(report->streams(0).gap_count(), 0U);
  EXPECT_NEAR(report->streams(0).rate_hz(), 100.0, 5.0);
}

INSTANTIATE_TEST_SUITE_P(Seconds, ClockStep, ::testing::Values(5, -5, 3600, -3600));

}  // namespace
}  // namespace imunoise::acquire
