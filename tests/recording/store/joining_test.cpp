// Devices that join a replicate while others are recorded.

#include <gtest/gtest.h>

#include <condition_variable>
#include <mutex>

#include "recording/store/manifest/manifest.h"
#include "recording/store/recorder/recorder.h"
#include "recording/store/verify/verify.h"
#include "tests/recording/store/fake_disk.h"
#include "tests/recording/store/samples.h"

namespace imunoise::recording {
namespace {

const std::filesystem::path kRecording = "/run";

// A disk on which no chunk is made before it may be.
class HeldChunks final : public FileSystem {
 public:
  using Path = std::filesystem::path;

  Result<std::unique_ptr<WritableFile>> create(const Path& path) override {
    if (path.filename() == "000001.h5.part") {
      std::unique_lock guard(mutex_);
      ++waiting_;
      changed_.notify_all();
      changed_.wait(guard, [&] { return may_; });
    }
    return disk_.create(path);
  }
  Result<std::vector<std::string>> list(const Path& path) const override {
    return disk_.list(path);
  }
  Result<bool> exists(const Path& path) const override { return disk_.exists(path); }
  Result<std::uint64_t> free_space(const Path& path) const override {
    return disk_.free_space(path);
  }
  Result<void> rename(const Path& from, const Path& to) override { return disk_.rename(from, to); }
  Result<void> remove(const Path& path) override { return disk_.remove(path); }
  Result<void> make_folder(const Path& path) override { return disk_.make_folder(path); }
  Result<void> sync_folder(const Path& path) override { return disk_.sync_folder(path); }
  Result<std::unique_ptr<FolderLock>> lock(const Path& path) override { return disk_.lock(path); }

  void wait_for_a_chunk() {
    std::unique_lock guard(mutex_);
    changed_.wait(guard, [&] { return waiting_ > 0; });
  }
  void let_go() {
    const std::lock_guard guard(mutex_);
    may_ = true;
    changed_.notify_all();
  }

 private:
  Result<std::string> read_up_to(const Path& path, std::uint64_t limit) const override {
    return static_cast<const FileSystem&>(disk_).read(path, limit);
  }

  FakeDisk disk_;
  std::mutex mutex_;
  std::condition_variable changed_;
  int waiting_ = 0;
  bool may_ = false;
};

RecorderOptions a_chunk_each_block() {
  RecorderOptions out;
  out.sync_every = {};
  out.segments.bytes = 1;
  return out;
}

// So many that where the recorder finds its devices moves, while it makes a chunk of the first.
TEST(Joining, WhileAChunkIsMadeMovesNothingUnderIt) {
  constexpr std::size_t kJoining = 100;
  HeldChunks disk;
  const RecordingPlan plan{"bench", 1, kStart, {test_device("imu0")}};
  const auto recorder = Recorder::start(disk, kRecording, plan, a_chunk_each_block());
  ASSERT_TRUE(recorder) << recorder.error().message;
  ASSERT_TRUE((*recorder)->push(0, imu_block(0, 10)));
  disk.wait_for_a_chunk();
  for (std::size_t i = 1; i <= kJoining; ++i) {
    const auto added = (*recorder)->add(test_device("imu" + std::to_string(i)));
    ASSERT_TRUE(added) << added.error().message;
  }
  disk.let_go();
  for (std::size_t i = 0; i <= kJoining; i += kJoining)
    ASSERT_TRUE((*recorder)->push(i, imu_block(10, 10)));
  const auto closed = (*recorder)->close();
  ASSERT_TRUE(closed) << closed.error().message;
  EXPECT_EQ((*recorder)->state().counts[0][0].stored, 20U);
  EXPECT_EQ((*recorder)->state().counts[kJoining][0].stored, 10U);
  EXPECT_TRUE(verify_recording(disk, kRecording, false)->sound());
}

// A recording is of one device by each name: another serial number is another sensor.
TEST(Joining, RefusesAnotherDeviceOfTheSameName) {
  FakeDisk disk;
  const RecordingPlan first{"bench", 1, kStart, {test_device("imu0")}};
  {
    const auto recorder = Recorder::start(disk, kRecording, first);
    ASSERT_TRUE(recorder) << recorder.error().message;
    ASSERT_TRUE((*recorder)->push(0, imu_block(0, 10)));
    ASSERT_TRUE((*recorder)->close());
  }
  v1::RecordedDevice other = test_device("imu0");
  other.set_serial("0043");
  const auto refused = Recorder::start(disk, kRecording, {"bench", 2, kStart, {other}});
  ASSERT_FALSE(refused);
  EXPECT_NE(refused.error().message.find("0042"), std::string::npos) << refused.error().message;
  EXPECT_NE(refused.error().message.find("0043"), std::string::npos) << refused.error().message;
  v1::RecordedDevice silent = test_device("imu0");
  silent.clear_serial();
  const auto recorder = Recorder::start(disk, kRecording, {"bench", 2, kStart, {silent}});
  ASSERT_TRUE(recorder) << "one that does not say its number may be the same";
  other.set_name("imu1");
  EXPECT_TRUE((*recorder)->add(other));
  EXPECT_TRUE((*recorder)->close());
}

TEST(Joining, FailsWithTheDiskAndMayBeTriedAgain) {
  for (const FakeDisk::Call kind : {FakeDisk::Call::kMakeFolder, FakeDisk::Call::kCreate,
                                    FakeDisk::Call::kSync, FakeDisk::Call::kRename}) {
    for (const int nth : {1, 2}) {
      FakeDisk disk;
      const RecordingPlan plan{"bench", 1, kStart, {test_device("imu0")}};
      const auto recorder = Recorder::start(disk, kRecording, plan, a_chunk_each_block());
      ASSERT_TRUE(recorder) << recorder.error().message;
      disk.fail_once(kind, nth);
      auto added = (*recorder)->add(test_device("imu1"));
      EXPECT_EQ(added.has_value(), !disk.failed());
      added = (*recorder)->add(test_device("imu1" + std::string(added ? "b" : "")));
      ASSERT_TRUE(added) << added.error().message;
      ASSERT_TRUE((*recorder)->push(*added, imu_block(0, 10)));
      ASSERT_TRUE((*recorder)->close());
      EXPECT_EQ((*recorder)->state().counts[*added][0].stored, 10U);
      EXPECT_TRUE(verify_recording(disk, kRecording, false)->sound());
    }
  }
}

TEST(Joining, ThatFailedLeavesNoDeviceInTheManifest) {
  for (const FakeDisk::Call kind :
       {FakeDisk::Call::kCreate, FakeDisk::Call::kSync, FakeDisk::Call::kRename}) {
    for (const int nth : {1, 2}) {  // the recording's manifest, the replicate's
      SCOPED_TRACE(std::to_string(static_cast<int>(kind)) + ", call " + std::to_string(nth));
      FakeDisk disk;
      const RecordingPlan plan{"bench", 1, kStart, {test_device("imu0")}};
      const auto recorder = Recorder::start(disk, kRecording, plan, a_chunk_each_block());
      ASSERT_TRUE(recorder) << recorder.error().message;
      disk.fail_once(kind, nth);
      ASSERT_FALSE((*recorder)->add(test_device("imu1")));
      ASSERT_TRUE((*recorder)->push(0, imu_block(0, 10)));
      const auto closed = (*recorder)->close();
      ASSERT_TRUE(closed) << closed.error().message;
      const auto manifest = read_manifest(disk, kRecording);
      ASSERT_TRUE(manifest && *manifest);
      ASSERT_EQ((*manifest)->devices_size(), 1);
      EXPECT_EQ((*manifest)->devices(0).name(), "imu0");
      EXPECT_TRUE(verify_recording(disk, kRecording, false)->sound());
    }
  }
}

}  // namespace
}  // namespace imunoise::recording
