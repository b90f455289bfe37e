// Parts of imunoised by themselves.

#include <fmt/format.h>
#include <gtest/gtest.h>
#include <sys/stat.h>

#include <set>

#include "daemon/app/campaign_files.h"
#include "daemon/app/rate_limit.h"
#include "daemon/app/status_text.h"
#include "tests/daemon/whims.h"

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

class CampaignFolder : public testing::Whims {
 protected:
  void write(const std::string& file, const std::string& name, const std::string& folder,
             const std::string& more = "") const {
    std::ofstream(folder_ / file) << "name = \"" << name << "\"\nfolder = \""
                                  << (folder_ / folder).string() << "\"\nlength = \"1 s\"\n"
                                  << more
                                  << "[[device]]\nname = \"a\"\ndriver = \"whims\"\n"
                                     "options.file = \"a\"\n";
  }
  CampaignFiles read(const std::vector<CampaignFile>& in_force = {}) const {
    const std::vector<std::filesystem::path> places = {folder_};
    return read_campaigns(places, drivers(), in_force);
  }
  // "a=x b=y": files and the names of their campaigns.
  static std::string found(const CampaignFiles& files) {
    std::set<std::string> all;
    for (const CampaignFile& one : files.found)
      all.insert(one.file.stem().string() + "=" + one.campaign.name());
    return fmt::format("{}", fmt::join(all, " "));
  }
};

TEST_F(CampaignFolder, OfTwinsTheFirstIsTaken) {
  write("a.toml", "x", "x");
  write("b.toml", "x", "y");
  write("c.toml", "z", "x");
  const CampaignFiles files = read();
  EXPECT_EQ(found(files), "a=x");
  ASSERT_EQ(files.rejected.size(), 2U);
  EXPECT_NE(files.rejected[0].problems(0).find("has the same name 'x' as"), std::string::npos);
  EXPECT_NE(files.rejected[1].problems(0).find("has the same folder"), std::string::npos);
}

TEST_F(CampaignFolder, WhatIsInForceIsNotDisplaced) {
  write("b.toml", "x", "x");
  const auto in_force = read().found;
  write("a.toml", "x", "other");  // before it by name
  write("c.toml", "y", "./x/.");
  CampaignFiles files = read(in_force);
  EXPECT_EQ(found(files), "b=x");
  EXPECT_EQ(files.rejected.size(), 2U);
  write("b.toml", "x", "x", "nonsense = 1\n");
  files = read(in_force);
  EXPECT_EQ(found(files), "b=x") << "it stays as it was, and has its name";
  EXPECT_EQ(files.rejected.size(), 3U);
  write("b.toml", "z", "z");
  std::filesystem::remove(folder_ / "c.toml");
  EXPECT_EQ(found(read(in_force)), "a=x b=z") << "what it gave up may be taken";
}

TEST_F(CampaignFolder, ATwinOfAnotherFileStaysAsItWas) {
  write("a.toml", "x", "x");
  write("b.toml", "y", "y");
  const auto in_force = read().found;
  write("b.toml", "x", "y");
  const CampaignFiles files = read(in_force);
  EXPECT_EQ(found(files), "a=x b=y");
  EXPECT_EQ(files.rejected.size(), 1U);
}

TEST_F(CampaignFolder, WhatCannotBeReadIsNotGone) {
  write("a.toml", "x", "x");
  write("b.toml", "y", "y");
  const auto in_force = read().found;
  std::filesystem::remove(folder_ / "a.toml");
  EXPECT_EQ(found(read(in_force)), "b=y");
  std::filesystem::remove(folder_ / "b.toml");
  EXPECT_EQ(found(read(in_force)), "");
  std::filesystem::remove_all(folder_);
  EXPECT_EQ(found(read(in_force)), "a=x b=y") << "the folder is not there: is it mounted?";
}

TEST_F(CampaignFolder, WhatIsNoFileOrHasNoNameInUtf8IsTold) {
  write("a.toml", "x", "x");
  write("b\xe9.toml", "y", "y", "nonsense = 1\n");
  ASSERT_EQ(::mkfifo((folder_ / "c.toml").c_str(), 0600), 0);
  const CampaignFiles files = read();
  EXPECT_EQ(found(files), "a=x");
  ASSERT_EQ(files.rejected.size(), 2U);
  EXPECT_TRUE(files.rejected[0].file().ends_with("b\xEF\xBF\xBD.toml"));
  EXPECT_NE(files.rejected[0].problems(0).find("nonsense: unknown"), std::string::npos);
  EXPECT_NE(files.rejected[1].problems(0).find("is not a regular file"), std::string::npos);
}

}  // namespace
}  // namespace imunoise::app
