// The recorder with its threads, on good disks and bad ones.

#include "recording/store/recorder/recorder.h"

#include <gtest/gtest.h>

#include <array>
#include <deque>
#include <thread>

#include "recording/store/format/layout.h"
#include "recording/store/recovery/recover.h"
#include "recording/store/verify/verify.h"
#include "tests/recording/files.h"
#include "tests/recording/store/fake_disk.h"
#include "tests/recording/store/samples.h"

namespace imunoise::recording {
namespace {

RecordingPlan plan(std::vector<v1::RecordedDevice> devices = {test_device()},
                   std::uint32_t replicate = 1) {
  return {"bench", replicate, kStart, std::move(devices)};
}

RecorderOptions small_segments(std::uint64_t bytes = 2000) {
  RecorderOptions out;
  out.segments.bytes = bytes;
  out.sync_every = {};
  return out;
}

// received = stored + refused, on every stream.
void expect_accounted(const Recorder& recorder) {
  for (const auto& device : recorder.state().counts) {
    for (const StreamCounts& counts : device) {
      EXPECT_EQ(counts.received, counts.stored + refused_rows(counts.refused));
    }
  }
}

DeviceRecording read_back(const FileSystem& files, const std::filesystem::path& root,
                          const std::string& folder = "replicate-1/imu0") {
  const auto manifest = read_manifest(files, root);
  EXPECT_TRUE(manifest && *manifest) << (manifest ? "no manifest" : manifest.error().message);
  const auto device = read_device(files, {root, folder}, **manifest);
  EXPECT_TRUE(device) << device.error().message;
  return *device;
}

class OnDisk : public FileTest {};

TEST_F(OnDisk, SeveralDevicesAndReplicatesComeBack) {
  FileSystem& files = posix_file_system();
  const auto root = path("run");
  RecorderOptions options = small_segments();
  options.waiting_rows = 300;  // what waits together goes into one segment
  for (const std::uint32_t replicate : {1U, 2U}) {
    const auto recorder = Recorder::start(
        files, root, plan({test_device("imu0"), test_device("imu1")}, replicate), options);
    ASSERT_TRUE(recorder) << recorder.error().message;
    for (int i = 0; i < 200; ++i) {
      for (const std::size_t device : {0U, 1U}) {
        ASSERT_TRUE((*recorder)->push(device, imu_block(10 * i, 10)));
        if (i % 10 != 0) continue;
        ASSERT_TRUE((*recorder)->push(device, slow_block(i / 10)));
      }
    }
    const auto closed = (*recorder)->close();
    ASSERT_TRUE(closed) << closed.error().message;
    expect_accounted(**recorder);
    EXPECT_EQ((*recorder)->state().counts[1][0].stored, 2000U);
  }
  for (const char* folder :
       {"replicate-1/imu0", "replicate-1/imu1", "replicate-2/imu0", "replicate-2/imu1"}) {
    const DeviceRecording device = read_back(files, root, folder);
    EXPECT_EQ(device.defects, std::vector<std::string>());
    EXPECT_GT(device.chunks, 3U);
    EXPECT_TRUE(holds_rows(row_indices(device.streams[0]), 2000));
    EXPECT_EQ(device.streams[0].channels, imu_block(0, 2000).rows.channels);
    EXPECT_EQ(device.streams[0].flags, std::vector<std::uint32_t>(2000, 0));
    EXPECT_EQ(device.streams[1].size(), 20U);
  }
  const auto report = verify_recording(files, root, false);
  ASSERT_TRUE(report);
  EXPECT_TRUE(report->sound()) << report->DebugString();
  EXPECT_EQ(report->streams_size(), 8);
}

TEST_F(OnDisk, ADeviceMayComeWhileOthersAreRecorded) {
  FileSystem& files = posix_file_system();
  const auto root = path("run");
  const auto recorder = Recorder::start(files, root, plan({test_device("imu0")}), small_segments());
  ASSERT_TRUE(recorder) << recorder.error().message;
  std::jthread first([&] {
    for (int i = 0; i < 400; ++i) EXPECT_TRUE((*recorder)->push(0, imu_block(10 * i, 10)));
  });
  std::deque<std::jthread> late;
  for (const char* const name : {"imu1", "imu2"}) {
    const auto added = (*recorder)->add(test_device(name));
    ASSERT_TRUE(added) << added.error().message;
    EXPECT_EQ(*added, late.size() + 1);
    EXPECT_EQ(read_manifest(files, root)->value().devices_size(), static_cast<int>(*added) + 1);
    late.emplace_back([&, device = *added] {
      for (int i = 0; i < 200; ++i) EXPECT_TRUE((*recorder)->push(device, imu_block(10 * i, 10)));
    });
  }
  EXPECT_FALSE((*recorder)->add(test_device("imu1"))) << "it is recorded already";
  first.join();
  late.clear();
  ASSERT_TRUE((*recorder)->close());
  expect_accounted(**recorder);
  EXPECT_TRUE(verify_recording(files, root, false)->sound());
  EXPECT_TRUE(holds_rows(row_indices(read_back(files, root).streams[0]), 4000));
  for (const char* folder : {"replicate-1/imu1", "replicate-1/imu2"})
    EXPECT_TRUE(holds_rows(row_indices(read_back(files, root, folder).streams[0]), 2000));
}

TEST_F(OnDisk, TwoRecordersDoNotShareAFolder) {
  FileSystem& files = posix_file_system();
  const auto first = Recorder::start(files, path("run"), plan());
  ASSERT_TRUE(first);
  const auto second = Recorder::start(files, path("run"), plan({test_device()}, 2));
  ASSERT_FALSE(second);
  expect_parts(second.error().message, {"run", "another process is recording"});
  const auto repair = verify_recording(files, path("run"), true);
  ASSERT_FALSE(repair);
  EXPECT_TRUE((*first)->close());
  const auto again = Recorder::start(files, path("run"), plan());
  EXPECT_TRUE(again) << "an empty replicate is no recording yet";
}

TEST_F(OnDisk, AReplicateIsRecordedOnce) {
  FileSystem& files = posix_file_system();
  {
    const auto first = Recorder::start(files, path("run"), plan());
    ASSERT_TRUE((*first)->push(0, imu_block(0, 10)));
  }
  const auto second = Recorder::start(files, path("run"), plan());
  ASSERT_FALSE(second);
  expect_parts(second.error().message, {"replicate-1/imu0", "recorded already"});
}

TEST(Recorder, RefusesWhatDoesNotFit) {
  FakeDisk disk;
  const auto recorder = Recorder::start(disk, "/run", plan());
  ASSERT_TRUE(recorder);
  Block block = imu_block(0, 4);
  block.rows.received = 9;
  const auto offered = (*recorder)->offer(0, block);
  ASSERT_FALSE(offered);
  EXPECT_NE(offered.error().message.find("device imu0: stream imu: 9 rows"), std::string::npos)
      << offered.error().message;
  EXPECT_FALSE(Recorder::start(disk, "/other", plan({})));
  EXPECT_FALSE(Recorder::start(disk, "/other", plan({test_device(), test_device()})));
}

// While the disk is full the queue runs over; every row of it is counted, what was stored before
// and after is there, and the place of the loss is marked.
TEST(Recorder, AFullDiskCostsCountedRowsOnly) {
  FakeDisk disk;
  RecorderOptions options = small_segments();
  options.waiting_rows = 40;
  const auto recorder = Recorder::start(disk, "/run", plan(), options);
  ASSERT_TRUE(recorder);
  for (int i = 0; i < 10; ++i) ASSERT_TRUE((*recorder)->push(0, imu_block(10 * i, 10)));
  disk.set_capacity(0);
  int next = 100;
  Result<void> refused = {};
  for (int tries = 0; refused && tries < 100; ++tries) {
    refused = (*recorder)->push(0, imu_block(next, 10));
    if (refused) next += 10;
  }
  ASSERT_FALSE(refused) << "a full disk was not noticed";
  EXPECT_NE(refused.error().message.find("No space left"), std::string::npos);
  EXPECT_TRUE((*recorder)->state().disks[0].trouble);
  int dropped = 0;
  for (int i = 0; i < 20; ++i, next += 10) {
    const auto taken = (*recorder)->offer(0, imu_block(next, 10));
    ASSERT_TRUE(taken);
    dropped += *taken ? 0 : 10;
  }
  EXPECT_GT(dropped, 0);
  disk.set_capacity(SIZE_MAX);
  // An attempt that began before there was room again may still fail.
  bool stored = false;
  for (int tries = 0; !stored && tries < 100; ++tries) {
    stored = (*recorder)->push(0, imu_block(next, 10)).has_value();
  }
  ASSERT_TRUE(stored);
  const auto closed = (*recorder)->close();
  ASSERT_TRUE(closed) << closed.error().message;
  expect_accounted(**recorder);
  const auto counts = (*recorder)->state().counts[0][0];
  ASSERT_EQ(counts.refused.size(), 1U);
  EXPECT_EQ(counts.refused[0],
            (Refusal{Refused::kOverrun, "", static_cast<std::uint64_t>(dropped)}));
  const DeviceRecording device = read_back(disk, "/run");
  EXPECT_EQ(device.defects, std::vector<std::string>());
  const Rows& rows = device.streams[0];
  EXPECT_EQ(rows.size(), counts.stored);
  EXPECT_EQ(rows.received, counts.received) << "the chunks account for the refused rows too";
  EXPECT_EQ(rows.refused, counts.refused);
  const std::vector<std::int32_t> indices = row_indices(rows);
  for (std::size_t i = 1; i < indices.size(); ++i) {
    ASSERT_EQ(indices[i] != indices[i - 1] + 1, (rows.flags[i] & kLostBefore) != 0) << indices[i];
  }
}

TEST(Recorder, ADiskThatStaysFullIsToldAtTheEnd) {
  FakeDisk disk;
  const auto recorder = Recorder::start(disk, "/run", plan(), small_segments());
  ASSERT_TRUE(recorder);
  ASSERT_TRUE((*recorder)->push(0, imu_block(0, 10)));
  while ((*recorder)->state().acknowledged[0] == 0) {
  }
  disk.set_capacity(0);
  ASSERT_TRUE((*recorder)->push(0, imu_block(10, 10)));
  const auto closed = (*recorder)->close();
  ASSERT_FALSE(closed);
  expect_accounted(**recorder);
  const auto refused = (*recorder)->state().counts[0][0].refused;
  ASSERT_EQ(refused.size(), 1U);
  EXPECT_EQ(refused[0].reason, Refused::kNotWritten);
  disk.set_capacity(SIZE_MAX);
  ASSERT_TRUE(recover_recording(disk, "/run"));
  EXPECT_TRUE(holds_rows(row_indices(read_back(disk, "/run").streams[0]), 10));
}

// After a failed fdatasync nobody knows what is on the disk: here the block is there, and is
// written again under its number. It is found once.
TEST(Journal, ABlockOfUnknownFateIsFoundOnce) {
  FakeDisk disk;
  const DeviceFolder where{"/run", "replicate-1/imu0"};
  for (const char* folder : {"/run", "/run/replicate-1", "/run/replicate-1/imu0"}) {
    ASSERT_TRUE(disk.make_folder(folder));
  }
  Journal journal(disk, where.path(), test_device(), {}, {});
  journal.append(imu_block(0, 10));
  ASSERT_TRUE(journal.sync());
  journal.append(imu_block(10, 10));
  disk.fail_syncs(true);
  ASSERT_FALSE(journal.sync());
  EXPECT_EQ(journal.acknowledged(), 1U);
  disk.fail_syncs(false);
  ASSERT_TRUE(journal.sync());
  EXPECT_EQ(journal.acknowledged(), 2U);
  journal.append(imu_block(20, 10));
  ASSERT_TRUE(journal.sync());
  const auto names = disk.list(where.path());
  EXPECT_EQ(*names, (std::vector<std::string>{"000001.journal", "000002.journal"}));
  ASSERT_TRUE(recover_recording(disk, "/run"));
  const DeviceRecording device = read_back(disk, "/run");
  EXPECT_EQ(device.chunks, 2U);
  EXPECT_EQ(row_indices(device.streams[0]).size(), 30U);
  EXPECT_TRUE(holds_rows(row_indices(device.streams[0]), 30));
}

TEST(Recorder, FailedSyncsLoseNothing) {
  FakeDisk disk;
  const auto recorder = Recorder::start(disk, "/run", plan(), small_segments());
  ASSERT_TRUE(recorder);
  for (int i = 0; i < 60; ++i) {
    disk.fail_syncs(i % 7 == 3);
    Result<void> pushed = (*recorder)->push(0, imu_block(10 * i, 10));
    ASSERT_TRUE(pushed);
  }
  disk.fail_syncs(false);
  ASSERT_TRUE((*recorder)->close());
  expect_accounted(**recorder);
  EXPECT_TRUE(holds_rows(row_indices(read_back(disk, "/run").streams[0]), 600));
}

TEST(Recorder, AReadOnlyDiskIsToldAtTheStart) {
  FakeDisk disk;
  disk.set_read_only(true);
  const auto recorder = Recorder::start(disk, "/run", plan());
  ASSERT_FALSE(recorder);
  EXPECT_NE(recorder.error().message.find("Read-only"), std::string::npos)
      << recorder.error().message;
}

// A sync costs the same however little it carries.
TEST(Recorder, BlocksWaitForTheNextRoundUnlessTheQueueFills) {
  FakeDisk disk;
  RecorderOptions options;
  options.sync_every = std::chrono::hours(1);
  options.waiting_rows = 1000;
  const auto recorder = Recorder::start(disk, "/run", plan(), options);
  ASSERT_TRUE((*recorder)->push(0, imu_block(0, 10)));  // the first round begins at once
  while ((*recorder)->state().acknowledged[0] == 0) {
  }
  const int calls = disk.calls();
  for (int i = 1; i <= 20; ++i) ASSERT_TRUE((*recorder)->push(0, imu_block(10 * i, 10)));
  EXPECT_EQ((*recorder)->state().acknowledged[0], 1U);
  EXPECT_EQ(disk.calls(), calls);
  for (int i = 21; i <= 40; ++i) ASSERT_TRUE((*recorder)->push(0, imu_block(10 * i, 10)));
  while ((*recorder)->state().acknowledged[0] < 26) {  // more than a quarter of the queue
  }
  ASSERT_TRUE((*recorder)->close());
  EXPECT_EQ((*recorder)->state().counts[0][0].stored, 410U);
}

// Counters that run to 2^bits - 1 and begin again.
TEST(Recorder, CountersUpTo63BitsComeBack) {
  for (const unsigned bits : {52U, 53U, 54U, 62U, 63U}) {
    SCOPED_TRACE(bits);
    FakeDisk disk;
    v1::RecordedDevice device = test_device();
    const std::uint64_t modulus = std::uint64_t{1} << bits;
    device.mutable_streams(0)->set_counter_modulus(modulus);
    const auto recorder = Recorder::start(disk, "/run", plan({device}), small_segments());
    ASSERT_TRUE(recorder) << recorder.error().message;
    Block block = imu_block(0, 100);
    for (std::size_t i = 0; i < 100; ++i)
      block.rows.counter[i] = static_cast<std::int64_t>((modulus - 50 + i) % modulus);
    ASSERT_TRUE((*recorder)->push(0, block));
    const auto closed = (*recorder)->close();
    ASSERT_TRUE(closed) << closed.error().message;
    const DeviceRecording back = read_back(disk, "/run");
    EXPECT_EQ(back.device.streams(0).counter_modulus(), modulus);
    EXPECT_EQ(back.streams[0].counter, block.rows.counter);
    const auto report = verify_recording(disk, "/run", false);
    EXPECT_TRUE(report->sound()) << report->DebugString();
    EXPECT_EQ(report->streams(0).gap_count(), 0U);
  }
  FakeDisk disk;
  v1::RecordedDevice device = test_device();
  device.mutable_streams(0)->set_counter_modulus((std::uint64_t{1} << 63U) + 1);
  EXPECT_FALSE(Recorder::start(disk, "/run", plan({device})));
}

// A unit that HDF5 takes and that no reader does: what was acknowledged stays in the journal.
TEST(Recorder, AChunkThatCannotBeReadBackKeepsItsJournal) {
  FakeDisk disk;
  v1::RecordedDevice device = test_device();
  device.mutable_streams(0)->mutable_channels(0)->set_units(std::string(5000, 'x'));
  const auto recorder = Recorder::start(disk, "/run", plan({device}), small_segments());
  ASSERT_TRUE(recorder) << recorder.error().message;
  ASSERT_TRUE((*recorder)->push(0, imu_block(0, 10)));
  const auto closed = (*recorder)->close();
  ASSERT_FALSE(closed);
  expect_parts(closed.error().message, {"imu0", "cannot be read back", "units"});
  const auto names = list_device_files(disk, {"/run", "replicate-1/imu0"});
  EXPECT_EQ(names->journals, std::vector<std::uint64_t>{1});
  EXPECT_EQ(names->chunks, std::vector<std::uint64_t>());
}

// Nothing new has to come before it is tried again: a sync of the journal, a rename of a chunk.
TEST(Recorder, WhatFailedOnceIsTriedAgainByItself) {
  for (const FakeDisk::Call kind : {FakeDisk::Call::kSync, FakeDisk::Call::kRename}) {
    FakeDisk disk;
    const auto recorder = Recorder::start(disk, "/run", plan(), small_segments(1));
    ASSERT_TRUE(recorder);
    disk.fail_once(kind, 1);
    ASSERT_TRUE((*recorder)->push(0, imu_block(0, 10)));
    const auto end = std::chrono::steady_clock::now() + std::chrono::seconds(10);
    const auto chunks = [&] {
      return list_device_files(disk, {"/run", "replicate-1/imu0"})->chunks.size();
    };
    while (chunks() == 0 && std::chrono::steady_clock::now() < end) {
    }
    EXPECT_TRUE(disk.failed());
    EXPECT_EQ(chunks(), 1U);
    EXPECT_EQ((*recorder)->state().acknowledged[0], 1U);
    ASSERT_TRUE((*recorder)->close());
    EXPECT_FALSE((*recorder)->state().disks[0].trouble);
  }
}

TEST(Recorder, HostTimeEndsSegmentsToo) {
  FakeDisk disk;
  RecorderOptions options;
  options.segments.time = std::chrono::seconds(1);
  options.sync_every = {};
  const auto recorder = Recorder::start(disk, "/run", plan(), options);
  for (int i = 0; i < 50; ++i) {
    ASSERT_TRUE((*recorder)->push(0, imu_block(10 * i, 10)));  // 0.1 s each
    while ((*recorder)->state().acknowledged[0] < static_cast<std::uint64_t>(i) + 1) {
    }
  }
  ASSERT_TRUE((*recorder)->close());
  const DeviceRecording device = read_back(disk, "/run");
  EXPECT_EQ(device.chunks, 5U);
}

}  // namespace
}  // namespace imunoise::recording
