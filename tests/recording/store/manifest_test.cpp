// Manifests: of a recording and of each replicate, and those of version 1, which had one file.

#include "recording/store/manifest/manifest.h"

#include <gtest/gtest.h>

#include <iostream>
#include <random>
#include <set>

#include "recording/store/manifest/replicate_set.h"
#include "recording/store/recorder/recorder.h"
#include "recording/store/verify/verify.h"
#include "tests/recording/files.h"
#include "tests/recording/store/fake_disk.h"
#include "tests/recording/store/samples.h"
#include "tests/recording/store/whole_manifest.h"

namespace imunoise::recording {
namespace {

const std::filesystem::path kFolder = "/run";

RecordingPlan noted(std::uint32_t replicate) {
  return {"bench", replicate, kStart, {test_device()}, v1::ReplicateNote()};
}

void record_rows(FileSystem& files, std::uint32_t replicate) {
  const auto recorder = Recorder::start(files, kFolder, noted(replicate));
  ASSERT_TRUE(recorder) << recorder.error().message;
  ASSERT_TRUE((*recorder)->push(0, imu_block(0, 10)));
  v1::ReplicateNote note;
  note.set_state(v1::complete);
  const auto closed = (*recorder)->close([&](const RecorderState&) { return note; });
  ASSERT_TRUE(closed) << closed.error().message;
}

std::string told_by_verify(FileSystem& files, bool repair = false) {
  const auto report = verify_recording(files, kFolder, repair);
  if (!report) return report.error().message;
  std::string out = report->sound() ? "sound\n" : "";
  for (const v1::Defect& one : report->defects()) out += one.message() + "\n";
  return out;
}

// The same as a set of numbers, however they come and go.
TEST(ReplicateSet, IsTheSetOfItsNumbers) {
  constexpr std::uint32_t kSeed = 5;
  std::cout << "seed " << kSeed << "\n";
  std::mt19937 random(kSeed);
  ReplicateRanges ranges;
  std::set<std::uint32_t> numbers;
  for (int step = 0; step < 2000; ++step) {
    const auto number = static_cast<std::uint32_t>(1 + random() % 20);
    if (random() % 2 == 0) {
      insert(ranges, number);
      numbers.insert(number);
    } else {
      erase(ranges, number);
      numbers.erase(number);
    }
    for (std::uint32_t i = 0; i <= 21; ++i) ASSERT_EQ(holds(ranges, i), numbers.contains(i));
    ASSERT_TRUE(is_replicate_set(ranges, numbers.size()));
    for (int i = 1; i < ranges.size(); ++i)
      ASSERT_GT(ranges[i].first(), ranges[i - 1].last() + 1) << "neighbours are one range";
  }
  ranges.Clear();
  for (std::uint32_t i = 1; i <= 1000; ++i) insert(ranges, i);
  EXPECT_EQ(ranges.size(), 1);
  EXPECT_FALSE(is_replicate_set(ranges, 999));
}

// At every moment of its first start: whoever reads it knows whose recording it is.
TEST(Manifests, AreNeverThereWithoutTheCampaignsName) {
  FakeDisk whole;
  ASSERT_TRUE(Recorder::start(whole, kFolder, noted(1)));
  int there = 0;
  for (int cut = 0; cut <= whole.calls(); ++cut) {
    FakeDisk disk;
    disk.cut_power_after(cut);
    (void)Recorder::start(disk, kFolder, noted(1));
    disk.restore_power(FakeDisk::Unsynced::kKept, 1);
    if (!disk.list(kFolder)) continue;
    const auto manifest = read_manifest(disk, kFolder);
    ASSERT_TRUE(manifest) << manifest.error().message;
    if (!*manifest) continue;
    ++there;
    EXPECT_EQ((*manifest)->campaign(), "bench") << "cut after " << cut << " calls";
  }
  EXPECT_GT(there, 3);
}

TEST(Manifests, OfVersion1AreReadAndBecomeVersion2) {
  FakeDisk disk;
  for (const std::uint32_t replicate : {1U, 2U, 3U}) record_rows(disk, replicate);
  v1::Manifest before = read_manifest(disk, kFolder)->value();
  ASSERT_EQ(before.replicates_size(), 3);
  // As it was once: one file. What lies beside it is of a conversion that came to no end.
  ASSERT_TRUE(write_manifest_of_version_1(disk, kFolder, before));
  ASSERT_TRUE(disk.remove(kFolder / "replicate-2.json"));
  disk.overwrite(kFolder / "replicate-3.json", "{}");
  before.set_version(1);
  EXPECT_EQ(read_manifest(disk, kFolder)->value().DebugString(), before.DebugString());
  EXPECT_EQ(told_by_verify(disk), "sound\n");
  record_rows(disk, 4);
  const v1::Manifest after = read_manifest(disk, kFolder)->value();
  EXPECT_EQ(after.version(), 2U);
  EXPECT_EQ(after.replicates_size(), 4);
  for (int i = 0; i < 3; ++i)
    EXPECT_EQ(after.replicates(i).DebugString(), before.replicates(i).DebugString());
  EXPECT_EQ(told_by_verify(disk), "sound\n");
  EXPECT_TRUE(disk.exists(kFolder / "replicate-2.json").value());
}

TEST(Manifests, OfANewerVersionAreLeftAloneAndSaySo) {
  FakeDisk disk;
  record_rows(disk, 1);
  const std::string newer = R"({"version": 3, "something": ["new"]})";
  disk.overwrite(kFolder / "replicate-1.json", newer);
  const auto manifest = read_manifest(disk, kFolder);
  ASSERT_FALSE(manifest);
  expect_parts(manifest.error().message, {"replicate-1.json", "version 3", "a newer imunoise"});
  EXPECT_EQ(manifest.error().message.find("repair"), std::string::npos);
  expect_parts(told_by_verify(disk, true), {"replicate-1.json", "a newer imunoise"});
  const auto next = Recorder::start(disk, kFolder, noted(1));
  ASSERT_FALSE(next);
  EXPECT_EQ(*disk.read(kFolder / "replicate-1.json"), newer);
  EXPECT_FALSE(disk.exists(kFolder / "replicate-1.json.broken").value());
}

TEST(Manifests, OfOneReplicateAreMadeAgain) {
  for (const bool damaged : {false, true}) {
    FakeDisk disk;
    for (const std::uint32_t replicate : {1U, 2U}) record_rows(disk, replicate);
    if (damaged) {
      disk.overwrite(kFolder / "replicate-1.json", "{");
    } else {
      ASSERT_TRUE(disk.remove(kFolder / "replicate-1.json"));
    }
    expect_parts(told_by_verify(disk), {"replicate-1.json: ", "--repair makes it again"});
    EXPECT_FALSE(read_manifest(disk, kFolder)) << "half of it is not the whole";
    expect_parts(told_by_verify(disk, true), {"sound", "replicate-1.json: made from the chunks"});
    expect_parts(told_by_verify(disk), {"sound", "replicate-1.json"});
    const v1::Manifest manifest = read_manifest(disk, kFolder)->value();
    EXPECT_EQ(manifest.chunks_size(), 2);
    ASSERT_EQ(manifest.damaged_size(), 1) << "the loss stays on record";
    EXPECT_EQ(manifest.damaged(0).kept_as(), damaged ? "replicate-1.json.broken" : "");
    EXPECT_EQ(manifest.replicates_size(), 1) << "its note is lost";
  }
}

// A repair that ended before it could put on record what it set aside.
TEST(Manifests, ThatWereSetAsideAreOnRecordInTheEnd) {
  FakeDisk disk;
  record_rows(disk, 1);
  ASSERT_TRUE(replace_file(disk, kFolder / "manifest.json.broken", "{"));
  expect_parts(told_by_verify(disk), {"manifest.json.broken: was damaged", "--repair"});
  expect_parts(told_by_verify(disk, true), {"sound"});
  expect_parts(told_by_verify(disk), {"sound"});
}

TEST(Manifests, OfARecordingNameNoReplicatesWithoutEnd) {
  const auto parsed = parse_recording_manifest(
      "manifest.json", R"({"version": 2, "settled": [{"first": 1, "last": 4000000000}]})");
  ASSERT_FALSE(parsed);
  expect_parts(parsed.error().message, {"manifest.json", "settled"});
}

}  // namespace
}  // namespace imunoise::recording
