// Parts of imunoised by themselves.

#include <gtest/gtest.h>

#include "daemon/app/rate_limit.h"
#include "daemon/app/status_text.h"

namespace imunoise::app {
namespace {

using namespace std::chrono_literals;

TEST(RateLimit, LeavesOutWhatIsTooMuchAndCountsIt) {
  RateLimit limit(2, 60s);
  const RateLimit::Time begin{};
  EXPECT_EQ(limit.pass("a", begin), 0U);
  EXPECT_EQ(limit.pass("a", begin + 1s), 0U);
  EXPECT_EQ(limit.pass("a", begin + 2s), std::nullopt);
  EXPECT_EQ(limit.pass("a", begin + 59s), std::nullopt);
  EXPECT_EQ(limit.pass("b", begin + 59s), 0U) << "each source has a share of its own";
  EXPECT_EQ(limit.pass("a", begin + 60s), 2U);
  EXPECT_EQ(limit.pass("a", begin + 61s), 0U);
}

TEST(StatusText, IsOneLineForPeople) {
  v1::CampaignStatus status;
  status.set_campaign("array");
  status.set_phase(v1::recording);
  status.set_recording("recordings/2026-03-01T000000Z");
  status.set_replicate(2);
  status.set_replicates(6);
  status.set_attempt(3);
  status.set_reason("imu0 is missing (gone\n\x1b[31m)");
  EXPECT_EQ(status_text(status),
            "array: records replicate 2 of 6, as replicate-3 on disk "
            "(recordings/2026-03-01T000000Z); imu0 is missing (gone  [31m)");
  status.Clear();
  status.set_campaign("array");
  status.set_phase(v1::waiting);
  status.set_until_ns(1772323200'000'000'000);
  EXPECT_EQ(status_text(status),
            "array: waits for the next recording, until 2026-03-01 00:00:00 UTC");
}

}  // namespace
}  // namespace imunoise::app
