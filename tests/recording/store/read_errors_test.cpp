// A disk that cannot read for a moment, and one that has damaged what it holds: only the second
// costs a chunk, and then it is told everywhere.

#include <gtest/gtest.h>

#include <fstream>

#include "recording/store/format/layout.h"
#include "recording/store/recorder/recorder.h"
#include "recording/store/verify/verify.h"
#include "tests/recording/files.h"
#include "tests/recording/store/fake_disk.h"
#include "tests/recording/store/samples.h"
#include "tests/recording/store/whole_manifest.h"

namespace imunoise::recording {
namespace {

const std::filesystem::path kRun = "/run";
const std::filesystem::path kDevice = kRun / "replicate-1/imu0";

v1::ReplicateNote complete() {
  v1::ReplicateNote out;
  out.set_state(v1::complete);
  return out;
}

// Replicate `replicate`: three chunks of 10 rows, closed as complete.
void record_three(FileSystem& files, const std::filesystem::path& root, std::uint32_t replicate) {
  RecordingPlan plan{"bench", replicate, kStart, {test_device()}, v1::ReplicateNote()};
  RecorderOptions options;
  options.sync_every = {};
  options.segments.bytes = 1;  // a segment each block
  const auto recorder = Recorder::start(files, root, plan, options);
  ASSERT_TRUE(recorder) << recorder.error().message;
  for (int i = 0; i < 3; ++i) {
    ASSERT_TRUE((*recorder)->push(0, imu_block(10 * i, 10)));
    while ((*recorder)->state().acknowledged[0] < static_cast<std::uint64_t>(i) + 1) {
    }
  }
  const auto closed = (*recorder)->close([](const auto&) { return complete(); });
  ASSERT_TRUE(closed) << closed.error().message;
}

// As if the program had ended just before it could say that all is in chunks.
void leave_open(FileSystem& files, const std::filesystem::path& root) {
  v1::Manifest manifest = read_manifest(files, root).value().value();
  manifest.set_closed(false);
  manifest.mutable_replicates(0)->set_settled(false);
  ASSERT_TRUE(write_manifest(files, root, manifest));
}

Result<std::unique_ptr<Recorder>> start_second(FileSystem& files,
                                               const std::filesystem::path& root) {
  return Recorder::start(files, root, {"bench", 2, kStart, {test_device()}, v1::ReplicateNote()});
}

v1::VerifyReport verified(FileSystem& files, const std::filesystem::path& root,
                          bool repair = false) {
  const auto report = verify_recording(files, root, repair);
  EXPECT_TRUE(report) << report.error().message;
  return report ? *report : v1::VerifyReport();
}

std::string told(const v1::VerifyReport& report) {
  std::string out;
  for (const v1::Defect& one : report.defects())
    out += (one.repaired() ? "repaired: " : "defect: ") + one.message() + "\n";
  return out;
}

void expect_intact(FileSystem& files, const std::filesystem::path& root) {
  const v1::VerifyReport report = verified(files, root);
  EXPECT_TRUE(report.sound()) << told(report);
  EXPECT_EQ(report.streams(0).stored(), 30U);
  EXPECT_EQ(read_manifest(files, root)->value().replicates(0).state(), v1::complete);
}

TEST(ReadErrors, ANextReplicateThatCannotReadSetsNothingAside) {
  for (int nth = 1;; ++nth) {
    FakeDisk disk;
    record_three(disk, kRun, 1);
    leave_open(disk, kRun);
    disk.fail_once(FakeDisk::Call::kRead, nth);
    const auto second = start_second(disk, kRun);
    if (!disk.failed()) {  // it never reads so often
      EXPECT_GT(nth, 5) << "two manifests and three chunks";
      break;
    }
    ASSERT_FALSE(second) << "read " << nth;
    EXPECT_NE(second.error().message.find("Input/output error"), std::string::npos);
    EXPECT_EQ(*disk.list(kDevice),
              (std::vector<std::string>{"000001.h5", "000002.h5", "000003.h5"}));
    EXPECT_TRUE(contains(disk, kRun, kManifestName).value());
    {
      const auto again = start_second(disk, kRun);
      ASSERT_TRUE(again) << again.error().message;
      ASSERT_TRUE((*again)->close([](const auto&) { return complete(); }));
    }
    expect_intact(disk, kRun);
  }
}

TEST(ReadErrors, VerifyThatCannotReadSaysSo) {
  FakeDisk disk;
  record_three(disk, kRun, 1);
  for (int nth = 1; nth <= 4; ++nth) {
    disk.fail_once(FakeDisk::Call::kRead, nth);
    const auto report = verify_recording(disk, kRun, false);
    EXPECT_TRUE(disk.failed());
    if (report) {
      EXPECT_NE(told(*report).find("Input/output error"), std::string::npos);
    }
    if (report) {
      EXPECT_FALSE(report->sound());
    }
    disk.fail_once(FakeDisk::Call::kRead, nth);
    EXPECT_FALSE(verify_recording(disk, kRun, true)) << "what cannot be read is not repaired";
  }
  expect_intact(disk, kRun);
}

TEST(ReadErrors, ADamagedChunkIsToldEverywhere) {
  FakeDisk disk;
  record_three(disk, kRun, 1);
  leave_open(disk, kRun);
  std::string bytes = *disk.read(kDevice / "000002.h5");
  bytes[bytes.size() / 2] = static_cast<char>(bytes[bytes.size() / 2] ^ 4);
  disk.overwrite(kDevice / "000002.h5", bytes);
  {
    const auto second = start_second(disk, kRun);
    ASSERT_TRUE(second) << second.error().message;
    ASSERT_FALSE((*second)->repaired().empty());
    expect_parts((*second)->repaired().front(), {"000002.h5", "set aside as"});
    ASSERT_TRUE((*second)->close([](const auto&) { return complete(); }));
  }
  const v1::Manifest manifest = read_manifest(disk, kRun).value().value();
  ASSERT_EQ(manifest.damaged_size(), 1);
  EXPECT_EQ(manifest.damaged(0).file(), "replicate-1/imu0/000002.h5");
  EXPECT_EQ(manifest.damaged(0).kept_as(), "replicate-1/imu0/000002.h5.broken");
  EXPECT_EQ(manifest.damaged(0).samples(), 10U);
  EXPECT_EQ(manifest.replicates(0).state(), v1::interrupted);
  expect_parts(manifest.replicates(0).reason(), {"imu0", "10 of 30", "000002.h5"});
  EXPECT_EQ(manifest.replicates(1).state(), v1::complete);

  const v1::VerifyReport report = verified(disk, kRun);
  EXPECT_FALSE(report.sound());
  expect_parts(told(report),
               {"defect: replicate-1/imu0/000002.h5: was set aside as",
                "defect: replicate 1, device imu0, stream imu: 10 of 30 stored samples are missing",
                "--repair"});
  EXPECT_TRUE(verified(disk, kRun, true).sound());
  const v1::VerifyReport after = verified(disk, kRun);
  EXPECT_TRUE(after.sound()) << told(after);
  expect_parts(told(after), {"repaired: replicate 1, device imu0, stream imu: 10 of 30"});
}

TEST(ReadErrors, AFileThatNobodyPutOnRecordIsReported) {
  FakeDisk disk;
  record_three(disk, kRun, 1);
  ASSERT_TRUE(replace_file(disk, kDevice / "000009.h5.broken", "no chunk"));
  const v1::VerifyReport report = verified(disk, kRun);
  EXPECT_FALSE(report.sound());
  expect_parts(told(report), {"defect: replicate-1/imu0/000009.h5.broken", "--repair"});
  EXPECT_TRUE(verified(disk, kRun, true).sound());
  EXPECT_TRUE(verified(disk, kRun).sound());
}

// What HDF5 cannot decode is not damaged when it is what was written.
TEST(ReadErrors, AChunkThatIsAsItWasWrittenStays) {
  FakeDisk disk;
  record_three(disk, kRun, 1);
  leave_open(disk, kRun);
  disk.overwrite(kDevice / "000002.h5", "of another program");
  v1::Manifest manifest = read_manifest(disk, kRun).value().value();
  Chunk chunk;
  *manifest.mutable_chunks(1) = chunk_entry(manifest.chunks(1).file(), chunk, "of another program");
  manifest.mutable_chunks(1)->set_samples(10);
  ASSERT_TRUE(write_manifest(disk, kRun, manifest));
  const auto second = start_second(disk, kRun);
  ASSERT_TRUE(second) << second.error().message;
  expect_parts((*second)->repaired().front(), {"000002.h5", "leaves it unchanged"});
  EXPECT_EQ(disk.read(kDevice / "000002.h5").value(), "of another program");
  EXPECT_EQ((*second)->close([](const auto&) { return complete(); }).has_value(), true);
  EXPECT_FALSE(verified(disk, kRun).sound());
  EXPECT_EQ(read_manifest(disk, kRun)->value().replicates(0).state(), v1::complete)
      << "nothing is proven";
}

// Chunks that are away while another replicate begins, and there again before the next.
TEST(ReadErrors, WhatIsAwayForAMomentChangesNoPromise) {
  FakeDisk disk;
  record_three(disk, kRun, 1);
  leave_open(disk, kRun);
  const std::string bytes = disk.read(kDevice / "000002.h5").value();
  const auto state = [&] { return read_manifest(disk, kRun)->value().replicates(0); };
  ASSERT_TRUE(disk.remove(kDevice / "000002.h5"));
  record_three(disk, kRun, 2);
  EXPECT_EQ(state().state(), v1::complete);
  EXPECT_FALSE(state().settled());
  expect_parts(told(verified(disk, kRun)), {"10 of 30 stored samples are missing"});
  ASSERT_TRUE(replace_file(disk, kDevice / "000002.h5", bytes));
  record_three(disk, kRun, 3);
  EXPECT_EQ(state().state(), v1::complete);
  EXPECT_TRUE(state().settled());
  EXPECT_TRUE(verified(disk, kRun).sound());
}

class MissingFiles : public FileTest {};

TEST_F(MissingFiles, StayPromisedUntilTheLossIsAccepted) {
  FileSystem& files = posix_file_system();
  const auto root = path("run");
  record_three(files, root, 1);
  leave_open(files, root);
  std::filesystem::rename(root / "replicate-1/imu0/000002.h5", path("elsewhere"));
  for (const std::uint32_t replicate : {2U, 3U}) record_three(files, root, replicate);
  expect_parts(told(verified(files, root)),
               {"defect: replicate-1/imu0/000002.h5: is missing",
                "replicate 1, device imu0, stream imu: 10 of 30 stored samples are missing"});
  std::filesystem::rename(path("elsewhere"), root / "replicate-1/imu0/000002.h5");
  EXPECT_TRUE(verified(files, root).sound());
  std::filesystem::remove_all(root / "replicate-1");
  const v1::VerifyReport report = verified(files, root);
  EXPECT_FALSE(report.sound());
  expect_parts(told(report),
               {"replicate-1/imu0/000001.h5: is missing", "replicate-1/imu0/000003.h5: is missing",
                "replicate 1, device imu0, stream imu: 30 of 30 stored samples are missing"});
  EXPECT_TRUE(verified(files, root, true).sound());
  const v1::VerifyReport after = verified(files, root);
  EXPECT_TRUE(after.sound()) << told(after);
  expect_parts(told(after), {"repaired: replicate 1, device imu0, stream imu: 30 of 30"});
}

TEST_F(MissingFiles, ASparseManifestIsRefusedByItsLength) {
  FileSystem& files = posix_file_system();
  const auto root = path("run");
  record_three(files, root, 1);
  std::filesystem::resize_file(root / kManifestName, std::uintmax_t{1} << 40U);
  const auto manifest = read_manifest(files, root);
  ASSERT_FALSE(manifest);
  expect_parts(manifest.error().message, {"manifest.json", "is larger than"});
  EXPECT_FALSE(start_second(files, root));
  EXPECT_TRUE(std::filesystem::exists(root / kManifestName)) << "it is not set aside";
}

}  // namespace
}  // namespace imunoise::recording
