// Replicates on a disk that fails or hangs, and devices that end early.

#include <fcntl.h>
#include <sys/stat.h>

#include <algorithm>
#include <chrono>
#include <functional>
#include <thread>

#include "daemon/acquire/completeness.h"
#include "daemon/acquire/record_replicate.h"
#include "daemon/acquire/recorded_device.h"
#include "daemon/acquire/wire_file.h"
#include "recording/store/manifest/manifest.h"
#include "recording/store/verify/verify.h"
#include "tests/daemon/whims.h"
#include "tests/recording/store/fake_disk.h"
#include "tests/recording/store/whole_manifest.h"

namespace imunoise::acquire {
namespace {

using namespace std::chrono_literals;
using recording::FakeDisk;

// Whims at 100 Hz, on a disk in memory; five samples of each may wait.
class FailingDisk : public testing::Whims {
 protected:
  using Events = std::vector<std::pair<std::chrono::milliseconds, std::function<void()>>>;

  FailingDisk() {
    plan_.folder = "/bench/rec";
    plan_.duration = 700ms;
    plan_.reopening = Reopening{50ms, 200ms};
    plan_.recorder.waiting_rows = 5;
    plan_.recorder.sync_every = 20ms;
    EXPECT_TRUE(disk_.make_folder("/bench").has_value());
  }

  void add(const std::string& name) {
    tell(name, "here");
    plan_.devices.push_back(
        {name, *drivers().find("whims").value(), {{"file", word_of(name).string()}}});
  }
  Result<ReplicateOutcome> record(const Events& events) {
    const std::jthread other([&] {
      const auto begin = std::chrono::steady_clock::now();
      for (const auto& [at, happens] : events) {
        std::this_thread::sleep_until(begin + at);
        happens();
      }
    });
    return record_replicate(disk_, plan_, {}, Progress({}, source_.get_token()));
  }
  v1::ReplicateNote note() const {
    return recording::read_manifest(disk_, plan_.folder).value().value().replicates(0);
  }
  static void expect_told(const v1::ReplicateNote& note, const std::string& words) {
    EXPECT_EQ(note.state(), v1::interrupted);
    EXPECT_NE(note.reason().find(words), std::string::npos) << note.reason();
  }
  static std::uint64_t refused(const recording::StreamCounts& counts) {
    return recording::refused_rows(counts.refused);
  }

  FakeDisk disk_;
  ReplicatePlan plan_;
  std::stop_source source_;
};

TEST_F(FailingDisk, AShortFailureCostsNothing) {
  add("a");
  const auto done = record({{150ms, [&] { disk_.fail_syncs_in("/bench/rec/replicate-1/a"); }},
                            {400ms, [&] { disk_.fail_syncs_in(""); }}});
  ASSERT_TRUE(done.has_value()) << done.error().message;
  EXPECT_EQ(note().state(), v1::complete) << note().reason();
  EXPECT_EQ(done->devices[0].streams[0].stored, done->devices[0].streams[0].received);
}

TEST_F(FailingDisk, TheDeviceIsReadOnAndWhatIsLostIsCounted) {
  plan_.disk_patience = 0ms;
  add("a");
  int calls = 0;
  const auto done = record({{150ms,
                             [&] {
                               disk_.fail_syncs_in("/bench/rec/replicate-1/a");
                               calls = disk_.calls();
                             }},
                            {450ms, [&] {
                               calls = disk_.calls() - calls;
                               disk_.fail_syncs_in("");
                             }}});
  ASSERT_TRUE(done.has_value()) << done.error().message;
  const recording::StreamCounts& counts = done->devices[0].streams[0];
  EXPECT_EQ(counts.received, counts.stored + refused(counts));
  EXPECT_GT(refused(counts), 5U);
  EXPECT_GT(counts.received, 50U) << "it is read to the end";
  EXPECT_GT(counts.stored, 30U) << "what came after the failure is stored";
  EXPECT_LT(calls, 300) << "no storm of attempts";
  expect_told(note(), "device a: ");
  expect_told(note(), "samples were discarded");
}

TEST_F(FailingDisk, OneDeviceWhoseDiskFailsIsNotComplete) {
  plan_.disk_patience = 100ms;
  add("a");
  const auto begin = std::chrono::steady_clock::now();
  const auto done = record({{150ms, [&] { disk_.fail_syncs_in("/bench/rec/replicate-1/a"); }}});
  EXPECT_FALSE(done.has_value()) << "the campaign tries again";
  EXPECT_GE(std::chrono::steady_clock::now() - begin, 700ms) << "it is not given up before";
  expect_told(note(), "device a: ");
}

TEST_F(FailingDisk, ADeviceWhoseDiskFailsStopsNoOther) {
  plan_.recorder.waiting_rows = 1000;
  add("a");
  add("b");
  const auto done = record({{150ms, [&] { disk_.fail_syncs_in("/bench/rec/replicate-1/a"); }}});
  expect_told(note(), "device a: ");
  EXPECT_EQ(note().reason().find("device b"), std::string::npos) << note().reason();
  ASSERT_EQ(note().streams_size(), 2);
  EXPECT_GT(note().streams(1).stored(), 35U);
  EXPECT_EQ(note().streams(1).stored(), note().streams(1).received());
}

TEST_F(FailingDisk, ADiskThatHangsHoldsUpNoReader) {
  plan_.disk_patience = 0ms;
  add("a");
  plan_.duration.reset();
  const auto done = record({{150ms, [&] { disk_.hang_syncs_in("/bench/rec/replicate-1/a"); }},
                            {400ms, [&] { source_.request_stop(); }},
                            {600ms, [&] { disk_.let_go(); }}});
  ASSERT_TRUE(done.has_value()) << done.error().message;
  const recording::StreamCounts& counts = done->devices[0].streams[0];
  EXPECT_EQ(counts.received, counts.stored + refused(counts));
  EXPECT_GT(refused(counts), 0U);
}

TEST_F(FailingDisk, ADeviceThatFallsSilentIsNotComplete) {
  add("a");
  add("b");
  plan_.duration = 1600ms;
  const auto done = record({{300ms, [&] { tell("a", "silent"); }}});
  ASSERT_TRUE(done.has_value()) << done.error().message;
  expect_told(note(), "device a: its last sample came");
  EXPECT_EQ(note().reason().find("device b"), std::string::npos) << note().reason();
}

TEST_F(FailingDisk, ADeviceThatHasNothingMoreToSayIsNotComplete) {
  add("a");
  plan_.duration = 30s;
  const auto done = record({{200ms, [&] { tell("a", "over"); }}});
  ASSERT_TRUE(done.has_value()) << done.error().message;
  expect_told(note(), "device a: its last sample came");
}

TEST_F(FailingDisk, WhatHeldUpTheReplicateBeforeIsItsReason) {
  add("a");
  plan_.duration = 200ms;
  ASSERT_TRUE(record({}).has_value());
  v1::Manifest manifest = recording::read_manifest(disk_, plan_.folder).value().value();
  manifest.mutable_replicates(0)->set_state(v1::open);
  ASSERT_TRUE(recording::write_manifest(disk_, plan_.folder, manifest).has_value());
  plan_.replicate = 2;
  plan_.unfinished = "no space left on device";
  ASSERT_TRUE(record({}).has_value());
  expect_told(note(), "no space left on device");
}

TEST_F(FailingDisk, AnErrorOfAFullDiskSaysHowMuchIsFree) {
  plan_.disk_patience = 0ms;
  add("a");
  disk_.set_capacity(20'000'000);
  const auto done = record({{100ms, [&] { disk_.fail_syncs_in("/bench/rec/replicate-1/a"); }}});
  ASSERT_FALSE(done.has_value());
  EXPECT_NE(done.error().message.find("the disk of /bench/rec has 20 MB free, make room"),
            std::string::npos)
      << done.error().message;
}

TEST_F(FailingDisk, AReplicateDoesNotBeginWithoutRoom) {
  add("a");
  plan_.duration = 3600s;
  plan_.replicates_to_come = 5;
  plan_.reserve_bytes = 1'000'000;
  // 100 rows a second of 20 bytes, six hours, and one segment.
  constexpr std::size_t kNeeded = 6 * 3600 * 100 * 20 + (32U << 20U) + 1'000'000;
  disk_.set_capacity(kNeeded - 1);
  const auto done = record({});
  ASSERT_FALSE(done.has_value());
  EXPECT_NE(done.error().message.find("free some space"), std::string::npos)
      << done.error().message;
  EXPECT_FALSE(disk_.exists(plan_.folder).value());
}

TEST_F(FailingDisk, TheReserveEndsAReplicate) {
  add("a");
  plan_.duration = 20s;
  plan_.reserve_bytes = 1'000'000;
  const auto begin = std::chrono::steady_clock::now();
  const auto done = record({{700ms, [&] { disk_.set_capacity(1'000'000); }}});
  ASSERT_TRUE(done.has_value()) << done.error().message;
  EXPECT_GE(std::chrono::steady_clock::now() - begin, 700ms) << "not before";
  EXPECT_LT(std::chrono::steady_clock::now() - begin, 10s);
  expect_told(note(), "reserve");
  EXPECT_TRUE(recording::verify_recording(disk_, plan_.folder, false)->sound());
}

TEST(Shortfall, IsOfTheEndOrOfTheCount) {
  v1::RecordedDevice device;
  device.set_name("imu0");
  device.add_streams()->set_rate_hz(100.0);
  std::vector<recording::StreamCounts> counts(1);
  DeviceCourse course{device, counts, 59.0, 0, ""};
  counts[0].received = 5700;
  counts[0].stored = 1000;
  EXPECT_EQ(shortfall(course, 60.0), "") << "rejected on the way: told elsewhere";
  counts[0].received = 1000;
  EXPECT_EQ(shortfall(course, 60.0),
            "device imu0: 1000 of about 6000 samples came in 1 min: it was away for a while, or is "
            "slower than the 100 Hz that its driver says");
  counts[0].received = counts[0].stored = 5700;
  course.last_s = 7.0;
  EXPECT_EQ(shortfall(course, 60.0),
            "device imu0: its last sample came 7 s after the start; 5700 of about 6000 "
            "samples in 1 min are stored");
  counts[0].stored = 6000;
  EXPECT_EQ(shortfall(course, 60.0), "") << "a device that runs faster than real time";
  counts[0].stored = 0;
  course.last_s.reset();
  EXPECT_NE(shortfall(course, 60.0), "");
  EXPECT_EQ(shortfall(course, std::nullopt), "") << "without an end in sight";
  course.discarded = 3;
  EXPECT_NE(shortfall(course, std::nullopt), "");
  device.mutable_streams(0)->set_rate_hz(0.1);
  course.discarded = 0;
  course.last_s = 460.0;
  counts[0].stored = 40;
  EXPECT_EQ(shortfall(course, 600.0), "") << "20 periods";
  counts[0].stored = 0;
  course.last_s.reset();
  EXPECT_NE(shortfall(course, 600.0), "");
  course.from_s = 500.0;
  EXPECT_EQ(shortfall(course, 600.0), "") << "it joined too late for 20 samples";
  course.from_s = 0.0;
  EXPECT_EQ(shortfall(course, 5.0), "") << "its period is longer";
}

TEST_F(FailingDisk, OneErrorWhileADeviceJoinsDoesNotLoseIt) {
  add("a");
  add("b");
  tell("a", "absent");
  plan_.patience = 0s;
  plan_.duration = 1500ms;
  const auto done = record({{200ms, [&] {
                               disk_.fail_once(FakeDisk::Call::kMakeFolder, 1);
                               tell("a", "here");
                             }}});
  ASSERT_TRUE(done.has_value()) << done.error().message;
  EXPECT_TRUE(disk_.failed());
  ASSERT_EQ(done->devices.size(), 2U);
  EXPECT_GT(done->devices[1].streams[0].stored, 30U);
  ASSERT_EQ(note().missing_size(), 1);
  EXPECT_GT(note().missing(0).joined_ns(), note().started_ns());
}

// All are asked to end before any is waited for.
TEST_F(FailingDisk, StubbornDevicesEndAtTheSameTime) {
  for (const char* const name : {"a", "b", "c", "d", "e"}) {
    add(name);
    tell(name, "stubborn");
  }
  plan_.duration.reset();
  std::chrono::steady_clock::time_point asked;
  const auto done = record({{200ms, [&] {
                               asked = std::chrono::steady_clock::now();
                               source_.request_stop();
                             }}});
  ASSERT_TRUE(done.has_value()) << done.error().message;
  EXPECT_LT(std::chrono::steady_clock::now() - asked, 900ms) << "one after another: 1.5 s";
}

// A driver whose rows do not fit is at fault, not the disk.
TEST_F(FailingDisk, RowsThatDoNotFitEndTheDeviceAtOnce) {
  add("a");
  auto opened = open_device(plan_.devices[0], {}, {}, {});
  ASSERT_TRUE(opened.has_value()) << opened.error().message;
  ReaderPlan plan;
  plan.device = recorded_device("a", "whims", (*opened)->info());
  plan.driver = "whims";
  auto* const more = plan.device.mutable_streams(0)->add_channels();
  *more = plan.device.streams(0).channels(0);
  more->set_name("gyro_y");
  const auto recorder =
      recording::Recorder::start(disk_, plan_.folder, {"bench", 1, 0, {plan.device}});
  ASSERT_TRUE(recorder.has_value()) << recorder.error().message;
  Reader reader(**recorder, plan, std::move(*opened));
  const auto begin = std::chrono::steady_clock::now();
  while (!reader.ended() && std::chrono::steady_clock::now() - begin < 5s) {
  }
  reader.stop();
  EXPECT_LT(std::chrono::steady_clock::now() - begin, 5s) << "no patience as with a disk";
  ASSERT_TRUE(reader.failure().has_value());
  EXPECT_NE(reader.failure()->message.find("a fault of the driver"), std::string::npos)
      << reader.failure()->message;
  EXPECT_EQ(reader.disk_failure(), "");
}

// A pipe that nobody reads is as slow as a disk can be.
TEST_F(FailingDisk, AWireFileNeverWaitsForTheDisk) {
  const auto path = folder_ / "a.wire";
  ASSERT_EQ(::mkfifo(path.c_str(), 0600), 0);
  const int pipe = ::open(path.c_str(), O_RDONLY | O_NONBLOCK | O_CLOEXEC);
  ASSERT_GE(pipe, 0);
  WireFile file;
  file.open(recording::posix_file_system(), path);
  const std::vector<std::uint8_t> bytes(1U << 20U, 7);
  constexpr std::size_t kTwice = 2 * WireFile::kMostWaiting;
  for (std::size_t given = 0; given < kTwice; given += bytes.size()) file.take(bytes);
  std::size_t written = 0;
  std::jthread reader([&](const std::stop_token& stop) {
    std::vector<char> buffer(1U << 16U);
    for (ssize_t n = 0; !stop.stop_requested() || n > 0;) {
      n = ::read(pipe, buffer.data(), buffer.size());
      written += n > 0 ? static_cast<std::size_t>(n) : 0;
    }
  });
  EXPECT_FALSE(file.close().has_value());
  reader.request_stop();
  reader.join();
  ::close(pipe);
  EXPECT_GE(written, WireFile::kMostWaiting - bytes.size());
  EXPECT_LT(written, kTwice);
}

}  // namespace
}  // namespace imunoise::acquire
