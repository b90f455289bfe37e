// Every call of the disk fails once, while two devices are recorded in two replicates, and while
// what is there is recovered and verified. After each: no row is lost in silence.

#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cstdlib>
#include <functional>
#include <iostream>
#include <random>

#include "recording/store/format/layout.h"
#include "recording/store/journal/journal_reader.h"
#include "recording/store/recorder/recorder.h"
#include "recording/store/recovery/recover.h"
#include "recording/store/verify/verify.h"
#include "tests/recording/store/fake_disk.h"
#include "tests/recording/store/samples.h"

namespace imunoise::recording {
namespace {

using Call = FakeDisk::Call;

const std::filesystem::path kPlace = "/place";
constexpr std::size_t kDevices = 2;
constexpr int kRowsEach = 4;  // of a block
// Blocks that each device delivers, replicate by replicate: two segments, then one.
constexpr std::array kBlocksOf = {3, 1};
constexpr int kTries = 8;  // of what a caller tries again
constexpr int kPairs = 80;

// Under ThreadSanitizer, which takes twenty times as long, threads meet as well when each fourth
// call fails.
constexpr int each() {
#ifdef __has_feature
#if __has_feature(thread_sanitizer)
  return 4;
#endif
#endif
  return 1;
}

// IMUNOISE_PAIRS in the environment asks for more of them.
int pairs() {
  const char* const asked = std::getenv("IMUNOISE_PAIRS");  // NOLINT(concurrency-mt-unsafe)
  return asked != nullptr ? std::atoi(asked) : kPairs;
}

// The smallest device there is: HDF5 takes its time for each dataset.
v1::RecordedDevice small_device(const std::string& name) {
  v1::RecordedDevice out;
  out.set_name(name);
  v1::RecordedStream* const stream = out.add_streams();
  stream->set_name("imu");
  stream->set_rate_hz(100.0);
  *stream->add_channels() = channel("row", "<i4");
  return out;
}

Block small_block(int first) {
  Block out = imu_block(first, kRowsEach);
  out.rows.counter.clear();
  out.rows.channels.erase(out.rows.channels.begin());
  return out;
}

// What was handed over: rows of each device.
using Given = std::vector<std::uint64_t>;
using Outcome = std::vector<Given>;  // of each replicate

// One replicate, as acquisition records it: what fails is tried again, within reason. Rows that
// find no way in are handed to offer(), which counts them.
Given record_one(FakeDisk& disk, std::uint32_t replicate, int blocks) {
  RecordingPlan plan{"bench",
                     replicate,
                     kStart,
                     {small_device("imu0"), small_device("imu1")},
                     v1::ReplicateNote()};
  RecorderOptions options;
  options.sync_every = {};
  options.waiting_rows = kRowsEach;
  options.segments.bytes = 300;  // two blocks
  Given given(kDevices, 0);
  auto recorder = Recorder::start(disk, kPlace, plan, options);
  for (int i = 0; !recorder && i < kTries; ++i)
    recorder = Recorder::start(disk, kPlace, plan, options);
  if (!recorder) return given;
  for (int i = 0; i < blocks; ++i) {
    for (std::size_t device = 0; device < kDevices; ++device) {
      const Block block = small_block(i * kRowsEach);
      bool pushed = false;
      for (int k = 0; !pushed && k < kTries; ++k)
        pushed = (*recorder)->push(device, block).has_value();
      if (!pushed) (void)(*recorder)->offer(device, block);
      given[device] += kRowsEach;
    }
  }
  (void)(*recorder)->close([&](const RecorderState& state) {
    v1::ReplicateNote note;
    note.set_state(v1::complete);
    for (std::size_t device = 0; device < kDevices; ++device) {
      if (state.counts[device][0].stored < given[device]) note.set_state(v1::interrupted);
    }
    return note;
  });
  return given;
}

Outcome record_and_recover(FakeDisk& disk) {
  (void)disk.make_folder(kPlace);
  Outcome out;
  for (const int blocks : kBlocksOf)
    out.push_back(record_one(disk, static_cast<std::uint32_t>(out.size()) + 1, blocks));
  for (int i = 0; i < kTries && !recover_recording(disk, kPlace, Recovery::kUnsettled); ++i) {
  }
  return out;
}

std::uint64_t discarded(const v1::StreamCount& count) {
  std::uint64_t out = 0;
  for (const v1::RefusalCount& one : count.discarded()) out += one.samples();
  return out;
}

// Rows in chunks; each once and in order.
std::uint64_t rows_there(const FileSystem& disk, const v1::Manifest& manifest,
                         const std::string& folder) {
  if (!disk.list(kPlace / folder)) return 0;
  const auto device = read_device(disk, {kPlace, folder}, manifest);
  EXPECT_TRUE(device) << device.error().message;
  if (!device || device->streams.empty()) return 0;
  const auto& rows = std::get<std::vector<std::int32_t>>(device->streams[0].channels[0]);
  EXPECT_TRUE(std::is_sorted(rows.begin(), rows.end(), std::less_equal<>())) << folder;
  return rows.size();
}

// Nothing readable was set aside: what was is a segment whose last write was interrupted.
void expect_nothing_readable_aside(const FileSystem& disk) {
  EXPECT_FALSE(contains(disk, kPlace, "manifest.json.broken").value());
  const auto folders = find_device_folders(disk, kPlace);
  for (const DeviceFolder& where : *folders) {
    const auto names = list_device_files(disk, where);
    for (const std::string& name : names->broken) {
      EXPECT_TRUE(number_of(name_before(name), kJournalSuffix)) << name;
      const auto segment = read_segment(*disk.read(where.path() / name), 0, nullptr);
      ASSERT_TRUE(segment) << name;
      EXPECT_EQ(segment->damage.size(), 1U) << name << " is whole";
    }
  }
}

// The accounting of what is on the disk, once it works again. `lossless`: every row is there.
void expect_true(FakeDisk& disk, const Outcome& outcome, bool lossless) {
  disk.heal();
  if (!lossless && !disk.list(kPlace)) return;  // not even the folder could be made
  ASSERT_TRUE(recover_recording(disk, kPlace, Recovery::kUnsettled));
  const auto read = read_manifest(disk, kPlace);
  ASSERT_TRUE(read && *read);
  const v1::Manifest& manifest = **read;
  std::uint64_t stored = 0;
  std::uint64_t found = 0;
  for (const v1::ReplicateNote& note : manifest.replicates()) {
    const Given& given = outcome[note.replicate() - 1];
    if (lossless) {
      EXPECT_EQ(note.state(), v1::complete) << note.reason();
    }
    for (std::size_t device = 0; device < kDevices; ++device) {
      const std::string name = "imu" + std::to_string(device);
      const std::uint64_t there =
          rows_there(disk, manifest, replicate_folder(note.replicate()) + "/" + name);
      found += there;
      if (note.state() == v1::complete) {
        EXPECT_EQ(there, given[device]);
      }
      if (note.streams().empty()) {  // it was never closed, and says so
        EXPECT_NE(note.state(), v1::complete);
        continue;
      }
      const v1::StreamCount& count = note.streams(static_cast<int>(device));
      ASSERT_EQ(count.device(), name);
      EXPECT_EQ(count.received(), given[device]);
      EXPECT_EQ(count.received(), count.stored() + discarded(count) + count.not_written());
      EXPECT_GE(there, count.stored());
      stored += count.stored();
    }
  }
  if (lossless) {
    EXPECT_EQ(stored, kDevices * kRowsEach * (kBlocksOf[0] + kBlocksOf[1]));
  }
  expect_nothing_readable_aside(disk);
  const auto report = verify_recording(disk, kPlace, false);
  ASSERT_TRUE(report) << report.error().message;
  EXPECT_TRUE(report->sound()) << report->DebugString();
  std::uint64_t reported = 0;
  for (const v1::StreamIntegrity& one : report->streams()) reported += one.stored();
  EXPECT_EQ(reported, found);
}

// Calls that change nothing.
bool answers_only(Call kind) {
  return kind == Call::kRead || kind == Call::kList || kind == Call::kExists || kind == Call::kLock;
}

TEST(EveryCall, FailsOnceAndCostsNothing) {
  int runs = 0;
  for (int kind = 0; kind < FakeDisk::kKinds; ++kind) {
    for (const bool done : {false, true}) {
      if (done && answers_only(static_cast<Call>(kind))) continue;
      for (int nth = 1;; nth += each(), ++runs) {
        SCOPED_TRACE("kind " + std::to_string(kind) + ", call " + std::to_string(nth) +
                     (done ? ", done" : ""));
        FakeDisk disk;
        disk.fail_once(static_cast<Call>(kind), nth, done);
        const Outcome outcome = record_and_recover(disk);
        if (!disk.failed()) break;  // it never comes
        expect_true(disk, outcome, true);
        if (::testing::Test::HasFailure()) return;
      }
    }
  }
  std::cout << runs << " calls failed once\n";
  EXPECT_GT(runs, 150 / each());
}

// `count` faults of random calls, each up to `longest` calls of its kind long.
void fail_at_random(std::uint64_t first_seed, int runs, int count, int longest, bool lossless) {
  FakeDisk whole;
  record_and_recover(whole);
  for (int run = 0; run < runs; ++run) {
    const std::uint64_t seed = first_seed + static_cast<std::uint64_t>(run);
    SCOPED_TRACE("seed " + std::to_string(seed));
    std::mt19937_64 random(seed);
    FakeDisk disk;
    for (int i = 0; i < count; ++i) {
      const auto kind = static_cast<Call>(random() % FakeDisk::kKinds);
      const int calls = std::max(1, whole.calls(kind));
      const int nth = 1 + static_cast<int>(random() % static_cast<std::uint64_t>(calls));
      const int length = 1 + static_cast<int>(random() % static_cast<std::uint64_t>(longest));
      for (int k = 0; k < length; ++k) disk.fail_once(kind, nth + k, random() % 2 == 0);
    }
    expect_true(disk, record_and_recover(disk), lossless);
    if (::testing::Test::HasFailure()) return;
  }
}

TEST(EveryCall, RandomPairsFailAndCostNothing) {
  std::cout << "seeds 1 to " << pairs() << "\n";
  fail_at_random(1, pairs(), 2, 1, true);
}

// Longer than anybody tries again: rows are lost, and every one of them is told.
TEST(EveryCall, FailsForAWhileAndEveryLostRowIsTold) {
  std::cout << "seeds 1000001 to " << 1000000 + pairs() / 2 << "\n";
  fail_at_random(1'000'001, pairs() / 2, 1, 40, false);
}

}  // namespace
}  // namespace imunoise::recording
