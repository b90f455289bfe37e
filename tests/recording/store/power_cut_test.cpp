// The power fails at every call that writes, syncs, renames or removes. Every block that was
// acknowledged is in a chunk after the recovery, none is there twice.

#include <gtest/gtest.h>

#include "recording/store/recorder/recorder.h"
#include "recording/store/recovery/recover.h"
#include "recording/store/recovery/seal.h"
#include "tests/recording/store/fake_disk.h"
#include "tests/recording/store/samples.h"

namespace imunoise::recording {
namespace {

constexpr int kRowsABlock = 5;
constexpr int kBlocks = 14;
const std::filesystem::path kRoot = "/recording";
const DeviceFolder kWhere{kRoot, "replicate-1/imu0"};

// Records with one journal and no threads, two segments' worth at least, until the first error.
// Returns the rows acknowledged.
std::size_t record(FakeDisk& disk) {
  if (!disk.make_folder(kRoot) || !disk.sync_folder("/") ||
      !disk.make_folder(kRoot / "replicate-1") || !disk.sync_folder(kRoot) ||
      !disk.make_folder(kWhere.path()) || !disk.sync_folder(kRoot / "replicate-1")) {
    return 0;
  }
  SegmentLimits limits;
  limits.bytes = 1000;  // about three blocks
  Journal journal(disk, kWhere.path(), test_device(), {}, limits);
  std::size_t acknowledged = 0;
  std::uint64_t after = 0;
  for (int i = 0; i < kBlocks; ++i) {
    journal.append(imu_block(i * kRowsABlock, kRowsABlock));
    if (!journal.sync()) return acknowledged;
    acknowledged = static_cast<std::size_t>((i + 1) * kRowsABlock);
    for (const std::uint64_t number : journal.take_ended()) {
      const auto sealed = seal_segment(disk, kWhere, number, after);
      if (!sealed) return acknowledged;
      after = sealed->entry->last_sequence();
    }
  }
  return acknowledged;
}

// What is in chunks after a recovery; the recovery must leave nothing to do.
std::vector<std::int32_t> recovered_rows(FakeDisk& disk) {
  const auto recovered = recover_recording(disk, kRoot);
  EXPECT_TRUE(recovered) << recovered.error().message;
  if (!recovered) return {};
  const auto again = recover_recording(disk, kRoot);
  EXPECT_TRUE(again && again->repaired.empty()) << "a second recovery found work";
  std::vector<std::int32_t> out;
  const auto folders = find_device_folders(disk, kRoot);
  for (const DeviceFolder& where : *folders) {
    const auto device = read_device(disk, where, read_manifest(disk, kRoot)->value());
    EXPECT_TRUE(device) << device.error().message;
    if (!device) continue;
    EXPECT_EQ(device->defects, std::vector<std::string>());
    if (device->chunks > 0) out = row_indices(device->streams[0]);
  }
  return out;
}

constexpr FakeDisk::Unsynced kFates[] = {FakeDisk::Unsynced::kLost, FakeDisk::Unsynced::kKept,
                                         FakeDisk::Unsynced::kAny, FakeDisk::Unsynced::kAny,
                                         FakeDisk::Unsynced::kAny};

TEST(PowerCut, AtEveryBoundaryOfARecording) {
  FakeDisk whole;
  ASSERT_EQ(record(whole), kBlocks * kRowsABlock);
  const int calls = whole.calls();
  ASSERT_GT(calls, 45);
  std::uint64_t seed = 0;
  for (int cut = 0; cut <= calls; ++cut) {
    for (const FakeDisk::Unsynced fate : kFates) {
      FakeDisk disk;
      disk.cut_power_after(cut);
      const std::size_t acknowledged = record(disk);
      disk.restore_power(fate, ++seed);
      if (acknowledged == 0 && !disk.list(kRoot)) continue;
      ASSERT_TRUE(holds_rows(recovered_rows(disk), acknowledged))
          << "cut after " << cut << " calls, seed " << seed;
    }
  }
}

TEST(PowerCut, AgainAtEveryBoundaryOfTheRecovery) {
  const int calls = [] {
    FakeDisk whole;
    record(whole);
    return whole.calls();
  }();
  std::uint64_t seed = 1000;
  for (int cut = 10; cut <= calls; cut += 5) {
    for (int second = 0;; ++second) {
      FakeDisk disk;
      disk.cut_power_after(cut);
      const std::size_t acknowledged = record(disk);
      disk.restore_power(FakeDisk::Unsynced::kAny, ++seed);
      disk.cut_power_after(second);
      const bool finished = recover_recording(disk, kRoot).has_value();
      disk.restore_power(FakeDisk::Unsynced::kAny, ++seed);
      ASSERT_TRUE(holds_rows(recovered_rows(disk), acknowledged))
          << "cuts after " << cut << " and " << second << " calls, seed " << seed;
      if (finished) break;
    }
  }
}

// The whole recorder, its threads included: which call comes at the cut is a matter of chance.
TEST(PowerCut, AtEveryBoundaryOfARecorder) {
  const auto record_with_threads = [](FakeDisk& disk) -> std::uint64_t {
    RecordingPlan plan;
    plan.devices = {test_device()};
    RecorderOptions options;
    options.sync_every = {};
    options.segments.bytes = 1000;
    const auto recorder = Recorder::start(disk, kRoot, plan, options);
    if (!recorder) return 0;
    for (int i = 0; i < kBlocks; ++i) {
      if (!(*recorder)->push(0, imu_block(i * kRowsABlock, kRowsABlock))) break;
    }
    (void)(*recorder)->close();
    return (*recorder)->state().acknowledged[0] * kRowsABlock;
  };
  FakeDisk whole;
  ASSERT_EQ(record_with_threads(whole), kBlocks * kRowsABlock);
  std::uint64_t seed = 9000;
  for (int cut = 0; cut <= whole.calls(); ++cut) {
    for (const FakeDisk::Unsynced fate : {FakeDisk::Unsynced::kLost, FakeDisk::Unsynced::kAny}) {
      FakeDisk disk;
      disk.cut_power_after(cut);
      const std::uint64_t acknowledged = record_with_threads(disk);
      disk.restore_power(fate, ++seed);
      if (acknowledged == 0 && !disk.list(kRoot)) continue;
      ASSERT_TRUE(holds_rows(recovered_rows(disk), acknowledged))
          << "cut after " << cut << " calls, seed " << seed;
    }
  }
}

}  // namespace
}  // namespace imunoise::recording
