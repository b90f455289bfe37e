// Two devices, of which one lies on a disk that fails: the other's good syncs hide nothing.

#include <gtest/gtest.h>

#include "recording/store/recorder/recorder.h"
#include "recording/store/recovery/recover.h"
#include "recording/store/recovery/seal.h"
#include "recording/store/verify/verify.h"
#include "tests/recording/store/fake_disk.h"
#include "tests/recording/store/samples.h"

namespace imunoise::recording {
namespace {

const std::filesystem::path kBad = "/run/replicate-1/imu1";

RecordingPlan two_devices() {
  RecordingPlan plan{"bench", 1, kStart, {test_device("imu0"), test_device("imu1")}, {}};
  plan.note = v1::ReplicateNote();
  return plan;
}

RecorderOptions often() {
  RecorderOptions out;
  out.segments.bytes = 2000;
  out.waiting_rows = 40;
  out.sync_every = {};
  return out;
}

v1::ReplicateNote complete_note(std::string reason = "") {
  v1::ReplicateNote out;
  out.set_replicate(1);
  out.set_state(v1::complete);
  out.set_reason(std::move(reason));
  return out;
}

std::size_t rows_on_disk(const FileSystem& files, const std::string& device) {
  const auto manifest = read_manifest(files, "/run");
  const auto read = read_device(files, {"/run", "replicate-1/" + device}, manifest->value());
  EXPECT_TRUE(read) << read.error().message;
  return read->streams.empty() ? 0 : read->streams[0].size();
}

void expect_part(const std::string& text, const std::string& part) {
  EXPECT_NE(text.find(part), std::string::npos) << text;
}

TEST(TwoDisks, WhatOneDidNotTakeIsToldHoweverWellTheOtherWorks) {
  FakeDisk disk;
  auto recorder = Recorder::start(disk, "/run", two_devices(), often());
  ASSERT_TRUE(recorder);
  ASSERT_TRUE((*recorder)->push(1, imu_block(0, 10)));
  while ((*recorder)->state().acknowledged[1] == 0) {
  }
  disk.fail_syncs_in(kBad);
  int failures = 0;
  int given = 10;
  for (int i = 0; i < 100; ++i) {
    ASSERT_TRUE((*recorder)->push(0, imu_block(10 * i, 10)));
    const auto pushed = (*recorder)->push(1, imu_block(given, 10));
    if (pushed) {
      given += 10;
      continue;
    }
    ++failures;
    expect_part(pushed.error().message, kBad.string());
    expect_part(pushed.error().message, "Input/output error");
  }
  EXPECT_GT(failures, 0);
  (*recorder)->annotate(complete_note());
  const auto closed = (*recorder)->close();
  ASSERT_FALSE(closed) << "rows of imu1 were not written";
  expect_part(closed.error().message, "imu1");
  expect_part(closed.error().message, "Input/output error");
  const auto counts = (*recorder)->state().counts;
  EXPECT_EQ(counts[0][0].stored, 1000U);
  EXPECT_EQ(counts[1][0].received, static_cast<std::uint64_t>(given));
  EXPECT_EQ(counts[1][0].stored, 10U);
  const auto manifest = read_manifest(disk, "/run");
  const v1::ReplicateNote& note = manifest->value().replicates(0);
  EXPECT_EQ(note.state(), v1::interrupted);
  expect_part(note.reason(), "imu1");
  expect_part(note.reason(), "Input/output error");
  EXPECT_EQ(rows_on_disk(disk, "imu0"), 1000U);
  disk.fail_syncs_in({});
  ASSERT_TRUE(recover_recording(disk, "/run"));
  EXPECT_GE(rows_on_disk(disk, "imu1"), 10U) << "what was acknowledged";
}

TEST(TwoDisks, TheNoteIsMadeOfWhatWasStored) {
  FakeDisk disk;
  const auto recorder = Recorder::start(disk, "/run", two_devices(), often());
  ASSERT_TRUE(recorder);
  ASSERT_TRUE((*recorder)->push(0, imu_block(0, 10)));
  ASSERT_TRUE((*recorder)->push(0, slow_block(0)));
  Block refusing = imu_block(0, 20);
  refusing.rows.refused = {{Refused::kChecksum, "", 3}};
  refusing.rows.received += 3;
  ASSERT_TRUE((*recorder)->push(1, refusing));
  const auto closed = (*recorder)->close([](const RecorderState& state) {
    return complete_note(std::to_string(state.counts[0][0].stored) + " and " +
                         std::to_string(state.counts[1][0].stored) + " rows");
  });
  ASSERT_TRUE(closed) << closed.error().message;
  const auto manifest = read_manifest(disk, "/run");
  const v1::ReplicateNote& note = manifest->value().replicates(0);
  EXPECT_EQ(note.state(), v1::complete);
  EXPECT_EQ(note.reason(), "10 and 20 rows");
  ASSERT_EQ(note.streams_size(), 4);
  EXPECT_EQ(note.streams(1).device(), "imu0");
  EXPECT_EQ(note.streams(1).stream(), "slow");
  EXPECT_EQ(note.streams(1).stored(), 1U);
  const v1::StreamCount& count = note.streams(2);
  EXPECT_EQ(count.device(), "imu1");
  EXPECT_EQ(count.stream(), "imu");
  EXPECT_EQ(count.received(), 23U);
  EXPECT_EQ(count.stored(), 20U);
  ASSERT_EQ(count.discarded_size(), 1);
  EXPECT_EQ(count.discarded(0).samples(), 3U);
  EXPECT_EQ(count.not_written(), 0U);
}

TEST(TwoDisks, TroubleIsTheDevicesOwnAndEndsWithIt) {
  FakeDisk disk;
  const auto recorder = Recorder::start(disk, "/run", two_devices(), often());
  const auto before = std::chrono::steady_clock::now();
  disk.fail_syncs_in(kBad);
  ASSERT_TRUE((*recorder)->push(1, imu_block(0, 10)));
  while (!(*recorder)->state().disks[1].trouble) {
  }
  ASSERT_TRUE((*recorder)->push(0, imu_block(0, 10)));
  while ((*recorder)->state().acknowledged[0] == 0) {
  }
  const RecorderState state = (*recorder)->state();
  EXPECT_FALSE(state.disks[0].trouble);
  ASSERT_TRUE(state.disks[1].trouble);
  expect_part(state.disks[1].trouble->error.message, "Input/output error");
  EXPECT_GE(state.disks[1].trouble->since, before);
  EXPECT_GT(state.disks[1].trouble->since_ns, 0);
  disk.fail_syncs_in({});
  ASSERT_TRUE((*recorder)->push(1, imu_block(10, 10)));
  while ((*recorder)->state().acknowledged[1] < 2) {
  }
  EXPECT_FALSE((*recorder)->state().disks[1].trouble);
  EXPECT_TRUE((*recorder)->close());
}

TEST(TwoDisks, ASyncThatDoesNotReturnIsSeen) {
  FakeDisk disk;
  const auto recorder = Recorder::start(disk, "/run", two_devices(), often());
  const auto before = std::chrono::steady_clock::now();
  disk.hang_syncs_in(kBad);
  ASSERT_TRUE((*recorder)->push(1, imu_block(0, 10)));
  RecorderState state = (*recorder)->state();
  while (!state.disks[1].call || state.disks[1].call->what != "sync") state = (*recorder)->state();
  EXPECT_EQ(state.disks[1].call->path, kBad / "000001.journal");
  EXPECT_GE(state.disks[1].call->since, before);
  EXPECT_FALSE(state.disks[0].call);
  ASSERT_FALSE(state.calls.empty());
  disk.let_go();
  EXPECT_TRUE((*recorder)->close());
  EXPECT_TRUE((*recorder)->state().calls.empty());
}

// The segment was renamed, only the answer was an error: the next attempt tells what became of it.
TEST(Seal, ASegmentThatAnEarlierAttemptSetAsideIsTold) {
  FakeDisk disk;
  const DeviceFolder where{"/run", "replicate-1/imu0"};
  for (const char* folder : {"/run", "/run/replicate-1", "/run/replicate-1/imu0"}) {
    ASSERT_TRUE(disk.make_folder(folder));
  }
  Journal journal(disk, where.path(), test_device(), {}, {});
  for (const int first : {0, 10}) {
    journal.append(imu_block(first, 10));
    ASSERT_TRUE(journal.sync());
  }
  const std::filesystem::path file = where.path() / "000001.journal";
  const std::string whole = *disk.read(file);
  disk.overwrite(file, whole.substr(0, whole.size() - 20));
  disk.fail_once(FakeDisk::Call::kRename, 2, true);  // the first puts the chunk in place
  ASSERT_FALSE(seal_segment(disk, where, 1, 0));
  const auto sealed = seal_segment(disk, where, 1, 0);
  ASSERT_TRUE(sealed) << sealed.error().message;
  ASSERT_TRUE(sealed->entry);
  EXPECT_EQ(sealed->entry->samples(), 10U);
  EXPECT_TRUE(sealed->damage);
  EXPECT_TRUE(sealed->torn);
  EXPECT_EQ(sealed->kept_as, "000001.journal.broken");
}

// No later round would try again.
TEST(TwoDisks, OneFailureAtTheCloseCostsNothing) {
  FakeDisk disk;
  RecorderOptions options = often();
  options.sync_every = std::chrono::hours(1);
  const auto recorder = Recorder::start(disk, "/run", two_devices(), options);
  ASSERT_TRUE((*recorder)->push(0, imu_block(0, 1)));  // the first round begins at once
  while ((*recorder)->state().acknowledged[0] == 0) {
  }
  ASSERT_TRUE((*recorder)->push(1, imu_block(0, 5)));
  disk.fail_next_sync();
  const auto closed = (*recorder)->close([](const auto&) { return complete_note(); });
  ASSERT_TRUE(closed) << closed.error().message;
  EXPECT_EQ(read_manifest(disk, "/run")->value().replicates(0).state(), v1::complete);
  EXPECT_EQ(rows_on_disk(disk, "imu1"), 5U);
}

}  // namespace
}  // namespace imunoise::recording
