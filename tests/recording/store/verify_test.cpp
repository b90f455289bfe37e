// Damaged recordings: what is told, what is repaired, and that the rest is intact.

#include "recording/store/verify/verify.h"

#include <gtest/gtest.h>

#include <fstream>
#include <random>

#include "recording/store/format/layout.h"
#include "recording/store/reading/replicates.h"
#include "recording/store/recorder/recorder.h"
#include "tests/recording/files.h"
#include "tests/recording/store/samples.h"

namespace imunoise::recording {
namespace {

class Verify : public FileTest {
 protected:
  // Twelve chunks of 30 rows each, closed.
  Verify() {
    RecordingPlan plan;
    plan.devices = {test_device()};
    plan.campaign = "bench";
    RecorderOptions options;
    options.sync_every = {};
    options.segments.bytes = 1;  // a segment each block
    const auto recorder = Recorder::start(files_, root_, plan, options);
    for (int i = 0; i < 12; ++i) {
      EXPECT_TRUE((*recorder)->push(0, imu_block(30 * i, 30)));
      while ((*recorder)->state().acknowledged[0] < static_cast<std::uint64_t>(i) + 1) {
      }
    }
    EXPECT_TRUE((*recorder)->close());
  }

  std::filesystem::path file(const std::string& name) const {
    return root_ / "replicate-1/imu0" / name;
  }
  std::string bytes(const std::filesystem::path& path) const { return *files_.read(path); }
  void overwrite(const std::filesystem::path& path, const std::string& bytes) const {
    std::ofstream(path, std::ios::binary | std::ios::trunc) << bytes;
  }
  v1::VerifyReport verify(bool repair = false) const {
    const auto report = verify_recording(files_, root_, repair);
    EXPECT_TRUE(report) << report.error().message;
    return report ? *report : v1::VerifyReport();
  }
  std::string defects(const v1::VerifyReport& report) const {
    std::string out;
    for (const v1::Defect& defect : report.defects()) out += defect.message() + "\n";
    return out;
  }

  FileSystem& files_ = posix_file_system();
  std::filesystem::path root_ = path("run");
};

TEST_F(Verify, ASoundRecording) {
  const v1::VerifyReport report = verify();
  EXPECT_TRUE(report.sound()) << report.DebugString();
  EXPECT_EQ(report.chunks(), 12U);
  ASSERT_EQ(report.streams_size(), 2);
  EXPECT_EQ(report.streams(0).stored(), 360U);
  EXPECT_EQ(report.streams(0).gap_count(), 0U);
  EXPECT_NEAR(report.streams(0).rate_hz(), 100.0, 1e-9);
}

TEST_F(Verify, ADamagedChunkIsNamedAndSetAsideAndTheRestIsIntact) {
  const std::string before = bytes(file("000012.h5"));
  std::string damaged = before;
  damaged[damaged.size() / 2] = static_cast<char>(damaged[damaged.size() / 2] ^ 16);
  overwrite(file("000012.h5"), damaged);
  const v1::VerifyReport report = verify();
  EXPECT_FALSE(report.sound());
  EXPECT_EQ(report.chunks(), 11U);
  expect_parts(defects(report), {"chunk 000012.h5: ", "the 11 chunks before it are intact",
                                 "imunoise verify --repair keeps them"});
  EXPECT_EQ(bytes(file("000012.h5")), damaged) << "verify alone changes nothing";
  const v1::VerifyReport repaired = verify(true);
  EXPECT_TRUE(repaired.sound()) << defects(repaired);
  EXPECT_EQ(bytes(file("000012.h5.broken")), damaged);
  EXPECT_FALSE(std::filesystem::exists(file("000012.h5")));
  EXPECT_TRUE(verify().sound());
}

TEST_F(Verify, AFlippedBitAnywhereInAChunkIsSeen) {
  const std::string before = bytes(file("000005.h5"));
  std::mt19937_64 random(12);
  for (std::size_t i = 0; i < before.size(); i += 1 + random() % 97) {
    std::string damaged = before;
    damaged[i] = static_cast<char>(damaged[i] ^ (1 << (random() % 8)));
    overwrite(file("000005.h5"), damaged);
    const v1::VerifyReport report = verify();
    ASSERT_FALSE(report.sound()) << "byte " << i;
    ASSERT_EQ(report.chunks(), 11U);
    ASSERT_NE(defects(report).find("chunk 000005.h5: "), std::string::npos) << defects(report);
    ASSERT_EQ(report.streams(0).stored(), 330U);
    ASSERT_EQ(report.streams(0).gap_count(), 1U);
    ASSERT_EQ(report.streams(0).gaps(0).lost(), 30U);
  }
}

TEST_F(Verify, AMissingChunkIsNamed) {
  std::filesystem::remove(file("000003.h5"));
  expect_parts(defects(verify()), {"replicate-1/imu0/000003.h5: is missing"});
  EXPECT_TRUE(verify(true).sound());
}

TEST_F(Verify, ALostManifestIsMadeAgain) {
  v1::Manifest old = read_manifest(files_, root_)->value();
  std::filesystem::remove(root_ / kManifestName);
  expect_parts(defects(verify()), {"manifest.json: is missing", "--repair"});
  EXPECT_TRUE(verify(true).sound());
  const v1::Manifest made = read_manifest(files_, root_)->value();
  old.clear_campaign();  // only the manifest knew it
  EXPECT_EQ(made.DebugString(), old.DebugString());
}

TEST_F(Verify, ABrokenManifestIsSetAside) {
  overwrite(root_ / kManifestName,
            "{\"version\": 1, \"chunks\": [{\"file\": \"../../etc/passwd\"}]}");
  expect_parts(defects(verify()), {"'../../etc/passwd' is not a chunk of this folder"});
  EXPECT_TRUE(verify(true).sound());
  EXPECT_TRUE(std::filesystem::exists(root_ / "manifest.json.broken"));
}

TEST_F(Verify, ALaterVersionIsLeftAlone) {
  const std::string later = "{\"version\": 3, \"new_field\": true}";
  overwrite(root_ / kManifestName, later);
  expect_parts(defects(verify()), {"version 3", "up to 2", "a newer imunoise wrote it"});
  EXPECT_EQ(defects(verify()).find("--repair makes"), std::string::npos);
  const auto report = verify_recording(files_, root_, true);
  ASSERT_FALSE(report);
  EXPECT_EQ(bytes(root_ / kManifestName), later);
}

TEST_F(Verify, AJournalThatWasLeftBecomesAChunk) {
  // As a crash would leave it: blocks 13 and 14 in a segment, the second torn.
  Journal journal(files_, root_ / "replicate-1/imu0", test_device(), {1, 13, 13}, {});
  journal.append(imu_block(360, 30));
  ASSERT_TRUE(journal.sync());
  journal.append(imu_block(390, 30));
  ASSERT_TRUE(journal.sync());
  const std::string whole = bytes(file("000013.journal"));
  overwrite(file("000013.journal"), whole.substr(0, whole.size() - 100));
  v1::VerifyReport report = verify();
  EXPECT_FALSE(report.sound());
  EXPECT_EQ(report.streams(0).in_journal(), 30U);
  expect_parts(defects(report), {"000013.journal: 30 samples not in a chunk yet", "--repair"});
  report = verify(true);
  EXPECT_TRUE(report.sound()) << defects(report);
  EXPECT_EQ(report.streams(0).stored(), 390U);
  EXPECT_EQ(report.streams(0).gap_count(), 0U);
  EXPECT_EQ(bytes(file("000013.journal.broken")).size(), whole.size() - 100);
  EXPECT_TRUE(verify().sound());
}

TEST_F(Verify, OneChunkFileByItself) {
  const auto good = verify_chunk(files_, file("000002.h5"));
  ASSERT_TRUE(good);
  EXPECT_TRUE(good->sound());
  EXPECT_EQ(good->streams(0).stored(), 30U);
  overwrite(file("000002.h5"), "no chunk");
  const auto other = verify_chunk(files_, "good.csv");
  ASSERT_FALSE(other);
  EXPECT_NE(other.error().message.find("is not a recording"), std::string::npos);
  const auto bad = verify_chunk(files_, file("000002.h5"));
  ASSERT_TRUE(bad);
  EXPECT_FALSE(bad->sound());
}

TEST_F(Verify, ImportsAsReplicatesCutAtGaps) {
  ImportOptions options;
  options.channels = {"imu0/imu/gyro_x"};
  const auto whole = import_recording(files_, root_, options);
  ASSERT_TRUE(whole) << whole.error().message;
  ASSERT_EQ(whole->size(), 1U);
  EXPECT_EQ(whole->front().name, "replicate-1");
  const Signal signal = whole->front().channels.front().signal();
  ASSERT_EQ(signal.size(), 360U);
  EXPECT_EQ(signal.rate().value, 100.0);
  EXPECT_EQ(signal.quantity(), Quantity::kAngularRate);
  EXPECT_DOUBLE_EQ(signal.value(1), -993 * 0.05 * 0.017453292519943295);  // row 1: 7 - 1000
  EXPECT_TRUE(
      std::holds_alternative<std::vector<std::int16_t>>(*whole->front().channels[0].samples));

  std::filesystem::remove(file("000003.h5"));
  const auto damaged = import_recording(files_, root_, options);
  ASSERT_FALSE(damaged);
  expect_parts(damaged.error().message, {"000003.h5: is missing", "--repair"});
  verify(true);
  const auto parts = import_recording(files_, root_, options);
  ASSERT_TRUE(parts);
  ASSERT_EQ(parts->size(), 2U);
  EXPECT_EQ((*parts)[0].channels[0].count, 60U);
  EXPECT_EQ((*parts)[1].channels[0].begin, 60U);
  EXPECT_EQ((*parts)[1].channels[0].count, 270U);
  EXPECT_EQ((*parts)[1].name, "replicate-1#2");
  EXPECT_EQ((*parts)[0].timing.gaps, 1U);
  EXPECT_EQ((*parts)[0].timing.lost, 30U);
  EXPECT_EQ((*parts)[1].timing.gaps, 0U) << "told once";
  EXPECT_EQ((*parts)[1].origin.recording, 0U);
  EXPECT_EQ((*parts)[1].origin.first, 90U) << "the lost ones count";

  options.channels.clear();
  const auto both = import_recording(files_, root_, options);
  ASSERT_FALSE(both);
  expect_parts(both.error().message, {"different streams", "imu0/slow/temperature"});
}

TEST_F(Verify, AnotherFolderIsNoRecording) {
  const auto report = verify_recording(files_, path(""), false);
  ASSERT_FALSE(report);
  expect_parts(report.error().message, {"is not a recording", "manifest.json"});
}

}  // namespace
}  // namespace imunoise::recording
