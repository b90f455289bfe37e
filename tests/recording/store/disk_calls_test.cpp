// What is known of calls that have not returned, and the calls of the real disk that folders need.

#include "recording/store/disk/disk_calls.h"

#include <gtest/gtest.h>
#include <unistd.h>

#include <fstream>
#include <thread>

#include "recording/store/disk/watched_files.h"

namespace imunoise::recording {
namespace {

namespace fs = std::filesystem;

TEST(DiskCalls, AreKnownUntilTheyReturnTheOldestFirst) {
  DiskCalls calls;
  {
    DiskCalls::Watch first(calls, "calibration", "/a");
    const DiskCalls::Watch second(calls, "sync", "/b");
    ASSERT_EQ(calls.pending().size(), 2U);
    EXPECT_EQ(calls.pending()[0].what, "calibration");
    const auto since = calls.pending()[0].since;
    std::this_thread::sleep_for(std::chrono::milliseconds(1));
    first.progress();
    EXPECT_EQ(calls.pending()[0].what, "sync") << "the other one went on since";
    EXPECT_GT(calls.pending()[1].since, since);
  }
  EXPECT_TRUE(calls.pending().empty());
}

class RealFolder : public ::testing::Test {
 protected:
  RealFolder()
      : folder_(fs::temp_directory_path() / ("imunoise_calls_" + std::to_string(::getpid()))) {
    fs::remove_all(folder_);
    fs::create_directories(folder_);
  }
  ~RealFolder() override { fs::remove_all(folder_); }
  void write(const std::string& name) const { std::ofstream(folder_ / name) << "x"; }

  const fs::path folder_;
  DiskCalls calls_;
  WatchedFiles files_{posix_file_system(), calls_};
};

TEST_F(RealFolder, ATreeIsRemovedButNotWhatItsLinksLeadTo) {
  fs::create_directories(folder_ / "tree/inner/empty");
  fs::create_directories(folder_ / "other");
  write("tree/a");
  write("tree/inner/b");
  write("other/c");
  fs::create_directory_symlink(folder_ / "other", folder_ / "tree/link");
  const auto done = remove_tree(files_, folder_ / "tree");
  ASSERT_TRUE(done.has_value()) << done.error().message;
  EXPECT_FALSE(fs::exists(folder_ / "tree"));
  EXPECT_TRUE(fs::exists(folder_ / "other/c"));
  EXPECT_FALSE(remove_tree(files_, folder_ / "tree").has_value()) << "it is not there";
}

TEST_F(RealFolder, FreeSpaceIsThatOfTheNearestFolderThatExists) {
  const auto there = files_.free_space(folder_);
  const auto below = files_.free_space(folder_ / "absent_a" / "absent_b");
  ASSERT_TRUE(there.has_value() && below.has_value());
  EXPECT_GT(*there, 0U);
  EXPECT_NEAR(static_cast<double>(*below), static_cast<double>(*there), 1e9);
  EXPECT_TRUE(files_.free_space("not/there").has_value()) << "of where the program runs";
  EXPECT_TRUE(calls_.pending().empty());
}

}  // namespace
}  // namespace imunoise::recording
