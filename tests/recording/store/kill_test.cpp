// kill -9 of a process that records, at random moments: what it was told to be safe is in a chunk
// after the recovery, once.

#include <gtest/gtest.h>
#include <signal.h>
#include <sys/wait.h>
#include <unistd.h>

#include <chrono>
#include <cstdint>
#include <random>
#include <thread>

#include "core/support/parallel.h"
#include "recording/store/recorder/recorder.h"
#include "recording/store/verify/verify.h"
#include "tests/recording/files.h"
#include "tests/recording/store/samples.h"

namespace imunoise::recording {
namespace {

constexpr int kRowsABlock = 50;

// Records for ever, and writes the number of the last block that is safe into the pipe.
[[noreturn]] void record(const std::filesystem::path& root, int pipe) {
  RecordingPlan plan;
  plan.devices = {test_device()};
  RecorderOptions options;
  options.sync_every = {};
  options.segments.bytes = 20'000;  // some thirty blocks
  const auto recorder = Recorder::start(posix_file_system(), root, plan, options);
  if (!recorder) ::_exit(1);
  for (int i = 0;; ++i) {
    if (!(*recorder)->push(0, imu_block(i * kRowsABlock, kRowsABlock))) ::_exit(2);
    const std::uint64_t safe = (*recorder)->state().acknowledged[0];
    if (::write(pipe, &safe, sizeof safe) != sizeof safe) ::_exit(3);
  }
}

class Kill : public FileTest {
 protected:
  void once(std::uint64_t seed, std::chrono::microseconds delay) {
    SCOPED_TRACE("seed " + std::to_string(seed) + ", killed after " +
                 std::to_string(delay.count()) + " us");
    const auto root = path("run" + std::to_string(seed));
    int pipe[2] = {};
    ASSERT_EQ(::pipe(pipe), 0);
    const pid_t child = ::fork();
    if (child == 0) {
      ::close(pipe[0]);
      record(root, pipe[1]);
    }
    ::close(pipe[1]);
    std::uint64_t safe = 0;
    // The pipe is read while the child lives, else it would stand still when the pipe is full.
    std::thread reader([&] {
      std::uint64_t told = 0;
      while (::read(pipe[0], &told, sizeof told) == sizeof told) safe = told;
    });
    std::this_thread::sleep_for(delay);
    ASSERT_EQ(::kill(child, SIGKILL), 0);
    int status = 0;
    ASSERT_EQ(::waitpid(child, &status, 0), child);
    reader.join();
    ::close(pipe[0]);
    ASSERT_TRUE(WIFSIGNALED(status)) << "the child ended by itself: " << WEXITSTATUS(status);
    if (!std::filesystem::exists(root)) return;
    told_ += safe;
    const auto repaired = verify_recording(posix_file_system(), root, true);
    if (!repaired) {  // killed before anything of a recording was there
      ASSERT_EQ(safe, 0U) << repaired.error().message;
      return;
    }
    ASSERT_TRUE(repaired->sound()) << repaired->DebugString();
    const auto folders = find_device_folders(posix_file_system(), root);
    ASSERT_TRUE(folders);
    std::vector<std::int32_t> rows;
    for (const DeviceFolder& where : *folders) {
      const auto device = read_device(posix_file_system(), where, {});
      ASSERT_TRUE(device);
      if (device->chunks > 0) rows = row_indices(device->streams[0]);
    }
    ASSERT_TRUE(holds_rows(rows, safe * kRowsABlock));
  }

  std::uint64_t told_ = 0;  // blocks acknowledged in all runs
};

TEST_F(Kill, AtRandomMoments) {
  const ThreadLimit single(1);  // no thread but ours when it forks
  for (std::uint64_t seed = 1; seed <= IMUNOISE_KILLS; ++seed) {
    std::mt19937_64 random(seed);
    once(seed, std::chrono::microseconds(random() % 150'000));
    if (HasFatalFailure()) return;
  }
  EXPECT_GT(told_, 0U) << "no run got as far as an acknowledged block";
}

}  // namespace
}  // namespace imunoise::recording
