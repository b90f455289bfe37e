// A recording while its disk loses power, returns errors, fills up or hangs: what was acknowledged
// is there afterwards, once, and the recording is sound. scenarios/disk.sh prepares the disk.

#include <gtest/gtest.h>

#include <chrono>
#include <cstdio>
#include <cstdlib>
#include <filesystem>
#include <random>
#include <string>
#include <thread>

#include "core/support/parallel.h"
#include "tests/recording/store/endless_recording.h"

namespace imunoise::recording {
namespace {

class FaultyDisk : public ::testing::Test {
 protected:
  void SetUp() override {
    const char* const folder = std::getenv("IMUNOISE_DISK_FOLDER");
    const char* const script = std::getenv("IMUNOISE_DISK_SCRIPT");
    if (folder == nullptr || script == nullptr)
      GTEST_SKIP() << "SKIPPED: tests/hil/run.sh runs this in a virtual machine";
    folder_ = folder;
    script_ = script;
  }
  void command(const std::string& word) const {
    ASSERT_EQ(std::system((script_ + " " + word).c_str()), 0) << word;
  }
  // Each recording meets the trouble at a random moment: one in four possibly while it starts, the
  // others after their first acknowledged block. `before`: count only blocks that were acknowledged
  // before the trouble, because a disk without power accepts everything.
  void meet(const std::string& trouble, bool before, int cycles) {
    const ThreadLimit single(1);  // no thread but ours when it forks
    std::uint64_t told = 0;
    int with_blocks = 0;
    for (int cycle = 1; cycle <= cycles; ++cycle) {
      std::mt19937_64 random(static_cast<std::uint64_t>(cycle));
      const std::chrono::milliseconds delay(random() % 1000);
      SCOPED_TRACE(trouble + ", cycle " + std::to_string(cycle) + ", after " +
                   std::to_string(delay.count()) + " ms");
      const auto root = folder_ / "run";
      EndlessRecording recording(root);
      if (cycle % 4 != 0) wait_for_block(recording);
      std::this_thread::sleep_for(delay);
      const std::uint64_t safe_before = recording.safe();
      command(trouble);
      const std::uint64_t safe_at_end = recording.kill();
      command("restore");
      expect_recovered(root, before ? safe_before : safe_at_end);
      const std::uint64_t acknowledged = before ? safe_before : safe_at_end;
      told += acknowledged;
      with_blocks += acknowledged > 0 ? 1 : 0;
      std::printf("%s, cycle %d: %llu blocks acknowledged\n", trouble.c_str(), cycle,
                  static_cast<unsigned long long>(acknowledged));
      std::fflush(stdout);
      std::filesystem::remove_all(root);
      if (HasFailure()) return;
    }
    std::printf("%s: %d of %d cycles had acknowledged blocks, %llu in all\n", trouble.c_str(),
                with_blocks, cycles, static_cast<unsigned long long>(told));
    EXPECT_GE(4 * with_blocks, 3 * cycles) << "too few cycles had anything to lose";
  }

  static void wait_for_block(const EndlessRecording& recording) {
    constexpr std::chrono::seconds kLongest{30};
    const auto begin = std::chrono::steady_clock::now();
    while (recording.safe() == 0 && std::chrono::steady_clock::now() - begin < kLongest)
      std::this_thread::sleep_for(std::chrono::milliseconds(1));
  }

  std::filesystem::path folder_;
  std::string script_;
};

TEST_F(FaultyDisk, LosesPower) { meet("power_cut", true, 50); }
TEST_F(FaultyDisk, ReturnsErrors) { meet("errors", false, 5); }
TEST_F(FaultyDisk, FillsUp) { meet("full", false, 5); }
TEST_F(FaultyDisk, Hangs) { meet("hang", false, 5); }

}  // namespace
}  // namespace imunoise::recording
