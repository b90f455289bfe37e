#include "tests/recording/store/endless_recording.h"

#include <gtest/gtest.h>
#include <signal.h>
#include <sys/wait.h>
#include <unistd.h>

#include "recording/store/recorder/recorder.h"
#include "recording/store/verify/verify.h"
#include "tests/recording/store/samples.h"

namespace imunoise::recording {
namespace {

constexpr int kRowsABlock = 50;

// Writes the number of the last block that is safe into the pipe. A disk in trouble ends nothing:
// what it does not take is pushed again.
[[noreturn]] void record(const std::filesystem::path& root, int pipe) {
  RecordingPlan plan;
  plan.devices = {test_device()};
  RecorderOptions options;
  options.sync_every = {};
  options.segments.bytes = 20'000;  // some thirty blocks
  const auto recorder = Recorder::start(posix_file_system(), root, plan, options);
  if (!recorder) ::_exit(1);
  for (int i = 0;;) {
    if ((*recorder)->push(0, imu_block(i * kRowsABlock, kRowsABlock))) ++i;
    const std::uint64_t safe = (*recorder)->state().acknowledged[0];
    if (::write(pipe, &safe, sizeof safe) != sizeof safe) ::_exit(3);
  }
}

}  // namespace

EndlessRecording::EndlessRecording(const std::filesystem::path& root) {
  int pipe[2] = {};
  EXPECT_EQ(::pipe(pipe), 0);
  child_ = ::fork();
  if (child_ == 0) {
    ::close(pipe[0]);
    record(root, pipe[1]);
  }
  ::close(pipe[1]);
  pipe_ = pipe[0];
  // The pipe is read while the child lives, else it would stand still when the pipe is full.
  reader_ = std::thread([this] {
    std::uint64_t told = 0;
    while (::read(pipe_, &told, sizeof told) == sizeof told) safe_ = told;
  });
}

EndlessRecording::~EndlessRecording() {
  if (child_ > 0) kill();
}

std::uint64_t EndlessRecording::kill() {
  EXPECT_EQ(::kill(child_, SIGKILL), 0);
  int status = 0;
  EXPECT_EQ(::waitpid(child_, &status, 0), child_);
  child_ = 0;
  reader_.join();
  ::close(pipe_);
  EXPECT_TRUE(WIFSIGNALED(status)) << "the child ended by itself: " << WEXITSTATUS(status);
  return safe_;
}

void expect_recovered(const std::filesystem::path& root, std::uint64_t safe_blocks) {
  if (!std::filesystem::exists(root)) {
    EXPECT_EQ(safe_blocks, 0U) << "the folder is gone";
    return;
  }
  const auto repaired = verify_recording(posix_file_system(), root, true);
  if (!repaired) {  // ended before anything of a recording was there
    ASSERT_EQ(safe_blocks, 0U) << repaired.error().message;
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
  ASSERT_TRUE(holds_rows(rows, safe_blocks * kRowsABlock));
}

}  // namespace imunoise::recording
