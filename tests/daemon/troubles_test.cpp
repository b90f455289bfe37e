// Which campaign a call that hangs belongs to.

#include "daemon/app/troubles.h"

#include <gtest/gtest.h>

#include <filesystem>

namespace imunoise::app {
namespace {

using recording::DiskCall;

v1::Campaign campaign(const std::string& name, const std::string& folder) {
  v1::Campaign out;
  out.set_name(name);
  out.set_folder(folder);
  return out;
}

TEST(Troubles, BelongToTheCampaignInWhoseFolderACallHangs) {
  const std::vector<v1::Campaign> campaigns = {campaign("a", "/data/a"), campaign("b", "data/b/")};
  const live::LiveBoard board;
  const auto now = live::Steady::now();
  const auto long_since = now - live::kHangsAfter;
  const auto found = [&](const std::vector<DiskCall>& calls) {
    std::string out;
    for (const auto& [name, trouble] : find_troubles(campaigns, calls, board, now))
      out += name + ": " + trouble.what.substr(0, trouble.what.find(" does")) + "\n";
    return out;
  };
  EXPECT_EQ(found({{"sync", "/data/a/x", now}}), "") << "it may still return";
  EXPECT_EQ(found({{"sync", "/data/a/x", long_since}}), "a: the disk hangs: sync of /data/a/x\n");
  EXPECT_EQ(found({{"statfs", "/data/a", long_since}}), "a: the disk hangs: statfs of /data/a\n");
  EXPECT_EQ(found({{"stat", "/data/ab/x", long_since}}),
            "imunoised: the disk hangs: stat of /data/ab/x\n");
  const auto absolute = std::filesystem::current_path() / "data/b/x";
  EXPECT_EQ(found({{"read", absolute, long_since}, {"list", "./data/b", long_since}}),
            "b: the disk hangs: read of " + absolute.string() + "\n")
      << "the oldest, however its path is written";
}

TEST(Troubles, HangForAsLongAsTheyDo) {
  const auto now = live::Steady::now();
  const Troubles troubles = {{"a", {"the disk fails", now - live::kHangsAfter, false}},
                             {"b", {"the disk hangs", now - live::kHangsAfter, true}}};
  EXPECT_EQ(hanging_since(troubles, now).find("b: the disk hangs (since "), 0U);
  EXPECT_EQ(hanging_since(troubles, now - 2 * live::kHangsAfter), "");
}

}  // namespace
}  // namespace imunoise::app
