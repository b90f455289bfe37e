// Replicates of devices that come and go.

#include "daemon/acquire/record_replicate.h"

#include <array>
#include <atomic>
#include <chrono>
#include <thread>

#include "daemon/acquire/campaign/campaign_recorder.h"
#include "recording/store/manifest/manifest.h"
#include "recording/store/reading/device_recording.h"
#include "recording/store/verify/verify.h"
#include "tests/daemon/whims.h"
#include "tests/recording/store/whole_manifest.h"

namespace imunoise::acquire {
namespace {

using namespace std::chrono_literals;

class RecordReplicate : public testing::Whims {
 protected:
  RecordReplicate() {
    plan_.folder = folder_ / "recording";
    plan_.duration = 1.5s;
    plan_.patience = 300ms;
    plan_.reopening = Reopening{50ms, 200ms};
  }

  void add(const std::string& name, const std::string& word = "here") {
    tell(name, word);
    plan_.devices.push_back(
        {name, *drivers().find("whims").value(), {{"file", word_of(name).string()}}});
  }
  // Records, while words are told at their times.
  Result<ReplicateOutcome> record(
      const std::vector<std::tuple<std::chrono::milliseconds, std::string, std::string>>& told =
          {}) {
    const std::jthread teller([&](const std::stop_token&) {
      const auto begin = std::chrono::steady_clock::now();
      for (const auto& [at, device, word] : told) {
        std::this_thread::sleep_until(begin + at);
        tell(device, word);
      }
    });
    return record_replicate(recording::posix_file_system(), plan_, {},
                            Progress({}, source_.get_token()));
  }
  std::jthread stop_after(std::chrono::milliseconds time) {
    return std::jthread([this, time] {
      std::this_thread::sleep_for(time);
      source_.request_stop();
    });
  }
  v1::ReplicateNote note_on_disk(int index = 0) const {
    return recording::read_manifest(recording::posix_file_system(), plan_.folder)
        .value()
        .value()
        .replicates(index);
  }
  std::uint64_t lost_marks(const std::string& device) const {
    const auto read = recording::read_device(recording::posix_file_system(),
                                             {plan_.folder, "replicate-1/" + device}, {});
    std::uint64_t out = 0;
    for (const std::uint32_t flags : read.value().streams[0].flags) {
      out += (flags & recording::kLostBefore) != 0 ? 1U : 0U;
    }
    return out;
  }

  ReplicatePlan plan_;
  std::stop_source source_;
};

// The counter goes round every 2.56 s; the device's time and the host's are one here.
TEST_F(RecordReplicate, ComparesClocks) {
  add("a");
  plan_.devices[0].options.push_back({"speed", "20"});
  ASSERT_TRUE(record());
  const v1::ReplicateNote note = note_on_disk();
  ASSERT_EQ(note.clocks_size(), 1);
  EXPECT_EQ(note.clocks(0).device(), "a");
  EXPECT_EQ(note.clocks(0).stream(), "imu");
  EXPECT_TRUE(note.clocks(0).from_counter());
  EXPECT_GT(note.clocks(0).seconds(), 15.0);
  EXPECT_NEAR(note.clocks(0).ppm(), 0.0, 1e-3);
}

TEST_F(RecordReplicate, IsCompleteWhenItsTimeIsOver) {
  add("a");
  add("b");
  plan_.campaign = "bench";
  const auto done = record();
  ASSERT_TRUE(done.has_value()) << done.error().message;
  EXPECT_EQ(done->devices.size(), 2U);
  EXPECT_GT(done->devices[1].streams[0].stored, 75U);
  const v1::ReplicateNote note = note_on_disk();
  EXPECT_EQ(note.state(), v1::complete);
  EXPECT_EQ(note.missing_size(), 0);
  EXPECT_NEAR(static_cast<double>(note.ended_ns() - note.started_ns()) * 1e-9, 1.5, 1.0);
  EXPECT_EQ(
      recording::read_manifest(recording::posix_file_system(), plan_.folder)->value().campaign(),
      "bench");
  EXPECT_TRUE(
      recording::verify_recording(recording::posix_file_system(), plan_.folder, false)->sound());
}

TEST_F(RecordReplicate, ADeviceThatIsNotThereStopsNoOther) {
  add("a", "absent");
  add("b");
  const auto done = record();
  ASSERT_TRUE(done.has_value()) << done.error().message;
  ASSERT_EQ(done->devices.size(), 1U);
  EXPECT_EQ(done->devices[0].device.name(), "b");
  const v1::ReplicateNote note = note_on_disk();
  EXPECT_EQ(note.state(), v1::complete);
  ASSERT_EQ(note.missing_size(), 1);
  EXPECT_EQ(note.missing(0).device(), "a");
  EXPECT_NE(note.missing(0).reason().find("absent"), std::string::npos);
}

TEST_F(RecordReplicate, ADeviceThatCannotBeRecordedStopsNoOther) {
  add("a", "rateless");
  add("b");
  plan_.duration = 300ms;
  plan_.patience = 0ms;
  const auto done = record();
  ASSERT_TRUE(done.has_value()) << done.error().message;
  ASSERT_EQ(note_on_disk().missing_size(), 1);
  EXPECT_NE(note_on_disk().missing(0).reason().find("rate_hz 0 is not a sampling rate"),
            std::string::npos)
      << note_on_disk().missing(0).reason();
}

TEST_F(RecordReplicate, ADeviceThatComesInTimeTakesPart) {
  add("a", "absent");
  add("b");
  plan_.patience = 20s;
  const auto done = record({{500ms, "a", "here"}});
  ASSERT_TRUE(done.has_value()) << done.error().message;
  EXPECT_EQ(done->devices.size(), 2U);
  EXPECT_EQ(note_on_disk().missing_size(), 0);
}

// Remembers which devices there were.
class Onlooker : public ReplicateObserver {
 public:
  void begin(const ReplicatePlan&, const std::vector<v1::RecordedDevice>& devices) override {
    for (const auto& one : devices) join(one);
  }
  void join(const v1::RecordedDevice& device) override { seen_ += device.name() + " "; }
  void take(std::size_t device, const recording::Block&) override { latest_[device] = true; }
  void end() override {}

  std::string seen_;
  std::array<std::atomic<bool>, 2> latest_ = {};
};

TEST_F(RecordReplicate, ADeviceThatComesLateJoins) {
  add("a", "absent");
  add("b");
  plan_.duration = 2s;
  Onlooker onlooker;
  plan_.observer = &onlooker;
  const auto done = record({{800ms, "a", "here"}});
  ASSERT_TRUE(done.has_value()) << done.error().message;
  ASSERT_EQ(done->devices.size(), 2U);
  EXPECT_EQ(done->devices[1].device.name(), "a");
  EXPECT_GT(done->devices[1].streams[0].stored, 50U);
  EXPECT_LT(done->devices[1].streams[0].stored + 20, done->devices[0].streams[0].stored);
  EXPECT_EQ(onlooker.seen_, "b a ");
  EXPECT_TRUE(onlooker.latest_[1]);
  const v1::ReplicateNote note = note_on_disk();
  EXPECT_EQ(note.state(), v1::complete);
  ASSERT_EQ(note.missing_size(), 1);
  EXPECT_EQ(note.missing(0).device(), "a");
  EXPECT_GT(note.missing(0).joined_ns(), note.started_ns());
  EXPECT_LT(note.missing(0).joined_ns(), note.ended_ns());
  EXPECT_TRUE(
      recording::verify_recording(recording::posix_file_system(), plan_.folder, false)->sound());
}

TEST_F(RecordReplicate, StoppedItWaitsForNoLatecomer) {
  add("a", "absent");
  add("b");
  plan_.duration = 3600s;
  const std::jthread stopper = stop_after(1s);
  const auto begin = std::chrono::steady_clock::now();
  const auto done = record({{400ms, "a", "deaf"}});
  ASSERT_TRUE(done.has_value()) << done.error().message;
  EXPECT_LT(std::chrono::steady_clock::now() - begin, 3s);
  EXPECT_EQ(note_on_disk().missing(0).joined_ns(), 0);
}

TEST_F(RecordReplicate, WithoutAnyDeviceNothingIsMade) {
  add("a", "absent");
  const auto done = record();
  ASSERT_FALSE(done.has_value());
  EXPECT_NE(done.error().message.find("no device answers: a: driver whims"), std::string::npos)
      << done.error().message;
  EXPECT_FALSE(std::filesystem::exists(plan_.folder));
}

TEST_F(RecordReplicate, WithoutPatienceEveryDeviceMustOpen) {
  add("a", "absent");
  add("b");
  plan_.patience.reset();
  EXPECT_FALSE(record().has_value());
}

TEST_F(RecordReplicate, AnUnpluggedDeviceIsWaitedFor) {
  add("a");
  const auto done = record({{400ms, "a", "gone"}, {800ms, "a", "here"}});
  ASSERT_TRUE(done.has_value()) << done.error().message;
  EXPECT_EQ(done->devices[0].disconnections, 1U);
  EXPECT_EQ(note_on_disk().missing_size(), 0);
}

TEST_F(RecordReplicate, ADeviceThatIsGoneAtTheEndIsMissingWithItsReason) {
  add("a");
  add("b");
  const auto done = record({{400ms, "a", "gone"}});
  ASSERT_TRUE(done.has_value()) << done.error().message;
  const v1::ReplicateNote note = note_on_disk();
  EXPECT_EQ(note.state(), v1::complete);
  ASSERT_EQ(note.missing_size(), 1);
  EXPECT_EQ(note.missing(0).device(), "a");
  EXPECT_NE(note.missing(0).reason().find("disconnected"), std::string::npos);
  EXPECT_GT(done->devices[1].streams[0].stored, 75U) << "the other goes on";
}

TEST_F(RecordReplicate, ADeviceThatFailedIsOpenedAgain) {
  add("a");
  plan_.duration = 2s;
  const auto done = record({{400ms, "a", "broken"}, {600ms, "a", "absent"}, {900ms, "a", "here"}});
  ASSERT_TRUE(done.has_value()) << done.error().message;
  EXPECT_FALSE(done->devices[0].failure.has_value());
  EXPECT_EQ(done->devices[0].disconnections, 1U);
  EXPECT_GT(done->devices[0].streams[0].stored, 75U);
  EXPECT_EQ(lost_marks("a"), 1U) << "the gap is marked";
  EXPECT_EQ(note_on_disk().missing_size(), 0);
}

TEST_F(RecordReplicate, AnotherDeviceInItsPlaceIsNotTaken) {
  add("a");
  add("b");
  const auto done = record({{400ms, "a", "broken"}, {500ms, "a", "other"}});
  ASSERT_TRUE(done.has_value()) << done.error().message;
  ASSERT_EQ(note_on_disk().missing_size(), 1);
  EXPECT_NE(note_on_disk().missing(0).reason().find("serial 2"), std::string::npos)
      << note_on_disk().missing(0).reason();
}

TEST_F(RecordReplicate, WhenAllHaveFailedWithoutReopeningItIsInterrupted) {
  add("a");
  plan_.reopening.reset();
  const auto done = record({{300ms, "a", "broken"}});
  ASSERT_TRUE(done.has_value()) << done.error().message;
  EXPECT_EQ(note_on_disk().state(), v1::interrupted);
  EXPECT_NE(note_on_disk().reason().find("broken"), std::string::npos);
}

TEST_F(RecordReplicate, StoppedItWaitsForNoDeviceThatIsBeingOpened) {
  add("a", "deaf");
  const std::jthread stopper = stop_after(300ms);
  const auto begin = std::chrono::steady_clock::now();
  const auto done = record();
  ASSERT_FALSE(done.has_value());
  EXPECT_EQ(done.error().message, "stopped while devices were being opened");
  EXPECT_LT(std::chrono::steady_clock::now() - begin, 3s);
}

TEST_F(RecordReplicate, StoppedItWaitsForNoDeviceThatIsBeingOpenedAgain) {
  add("a");
  add("b");
  plan_.duration = 3600s;
  const std::jthread stopper = stop_after(1s);
  const auto begin = std::chrono::steady_clock::now();
  const auto done = record({{300ms, "a", "broken"}, {340ms, "a", "deaf"}});
  ASSERT_TRUE(done.has_value()) << done.error().message;
  EXPECT_LT(std::chrono::steady_clock::now() - begin, 3s);
  const v1::ReplicateNote note = note_on_disk();
  ASSERT_EQ(note.missing_size(), 1);
  EXPECT_EQ(note.missing(0).reason(), "driver whims: the device is broken");
}

TEST_F(RecordReplicate, StoppedItIsInterruptedAndClosed) {
  add("a");
  plan_.duration = 3600s;
  const std::jthread stopper = stop_after(500ms);
  const auto begin = std::chrono::steady_clock::now();
  const auto done = record();
  ASSERT_TRUE(done.has_value()) << done.error().message;
  EXPECT_LT(std::chrono::steady_clock::now() - begin, 5s);
  EXPECT_EQ(note_on_disk().state(), v1::interrupted);
  EXPECT_EQ(done->devices[0].streams[0].stored, done->devices[0].streams[0].received);
}

TEST_F(RecordReplicate, NotesOfOtherReplicatesStay) {
  add("a");
  plan_.duration = 300ms;
  ASSERT_TRUE(record().has_value());
  plan_.replicate = 2;
  ASSERT_TRUE(record().has_value());
  EXPECT_EQ(note_on_disk(0).replicate(), 1U);
  EXPECT_EQ(note_on_disk(1).replicate(), 2U);
}

TEST_F(RecordReplicate, AReplicateThatACrashLeftOpenWasInterrupted) {
  add("a");
  plan_.duration = 300ms;
  ASSERT_TRUE(record().has_value());
  auto& files = recording::posix_file_system();
  v1::Manifest manifest = recording::read_manifest(files, plan_.folder).value().value();
  manifest.mutable_replicates(0)->set_state(v1::open);
  ASSERT_TRUE(recording::write_manifest(files, plan_.folder, manifest).has_value());
  plan_.replicate = 2;
  ASSERT_TRUE(record().has_value());
  EXPECT_EQ(note_on_disk(0).state(), v1::interrupted);
  EXPECT_EQ(note_on_disk(1).state(), v1::complete);
}

}  // namespace
}  // namespace imunoise::acquire
