// Thirty simulated days of a bench: two devices that are damaged, lost and unplugged on the wire,
// and each day a fate: a disk that fails, fails for a while, is full or hangs, a cut of power, a
// kill, a clock that is set. At the end every sample is accounted for: what lies between the first
// and the last that are stored is stored, refused, reported lost, or reported as not written.
// IMUNOISE_DAYS and IMUNOISE_FIRST_SEED ask for others.

#include <chrono>
#include <cstdlib>
#include <iostream>
#include <map>
#include <random>
#include <set>
#include <thread>

#include "recording/store/manifest/device_folder.h"
#include "recording/store/manifest/manifest.h"
#include "recording/store/reading/device_recording.h"
#include "recording/store/recovery/recover.h"
#include "recording/store/verify/verify.h"
#include "tests/daemon/faults/run_once.h"
#include "tests/daemon/faults/set_clock.h"
#include "tests/daemon/whims.h"
#include "tests/recording/store/fake_disk.h"

namespace imunoise::acquire {
namespace {

using namespace std::chrono_literals;
using recording::FakeDisk;

const std::filesystem::path kRoot = "/bench/month";
constexpr int kSpeed = 10'000;
constexpr std::uint32_t kReplicates = 4;  // a day
constexpr double kLengthS = 86'400.0 / kReplicates / kSpeed;

enum class Fate { kNone, kErrors, kFailsForAWhile, kFull, kHangs, kPowerCut, kKilled, kClockSet };
constexpr std::array<const char*, 8> kFates = {"nothing",   "disk errors", "disk fails for a while",
                                               "disk full", "disk hangs",  "power cut",
                                               "killed",    "clock set"};

struct Tally {
  std::uint64_t sent = 0;
  std::uint64_t stored = 0;
  std::uint64_t refused = 0;
  std::uint64_t lost = 0;
  std::uint64_t not_written = 0;
  int complete = 0;
  int interrupted = 0;
};

class ThirtyDays : public testing::Whims {
 protected:
  static v1::Campaign campaign_of(int seed) {
    v1::Campaign out;
    out.set_name("month");
    out.set_folder(kRoot.string());
    out.set_replicates(kReplicates);
    out.set_length_s(kLengthS);
    out.set_patience_s(5.0);
    for (const int speed : {kSpeed, kSpeed / 20}) {
      v1::CampaignDevice& device = *out.add_devices();
      device.set_name("imu" + std::to_string(speed));
      device.set_driver("month");
      for (const auto& [name, value] : {std::pair("seed", seed), std::pair("speed", speed)}) {
        v1::CampaignOption& option = *device.add_options();
        option.set_name(name);
        option.set_value(std::to_string(value));
      }
    }
    return out;
  }
  // Whether it came to its end by itself.
  static bool run(const v1::Campaign& campaign, FakeDisk& disk) {
    return testing::run_once(campaign, drivers(), disk);
  }
};

std::vector<std::filesystem::path> recordings_on(const FakeDisk& disk) {
  std::vector<std::filesystem::path> out;
  const auto names = disk.list(kRoot);
  if (!names) return out;
  for (const std::string& name : *names) out.push_back(kRoot / name.substr(0, name.size() - 1));
  return out;
}

// What happens to a disk, at some time of the day.
void befall(Fate fate, FakeDisk& disk, std::mt19937_64& random) {
  const auto any = [&](int most) { return std::uniform_int_distribution<int>(0, most)(random); };
  switch (fate) {
    case Fate::kNone:
      return;
    case Fate::kErrors:
      for (int k = 0; k < 10; ++k)
        disk.fail_once(static_cast<FakeDisk::Call>(any(FakeDisk::kKinds - 1)), 1 + any(20),
                       any(1) == 1);
      return;
    case Fate::kFailsForAWhile:
      for (int k = 0; k < 6; ++k) disk.fail_once(FakeDisk::Call::kSync, 1 + k);
      return;
    case Fate::kFull:
      disk.set_capacity(1);
      std::this_thread::sleep_for(std::chrono::milliseconds(100 + any(400)));
      disk.set_capacity(std::size_t{1} << 40U);
      return;
    case Fate::kHangs:
      for (const std::filesystem::path& folder : recordings_on(disk)) disk.hang_syncs_in(folder);
      std::this_thread::sleep_for(std::chrono::milliseconds(100 + any(400)));
      disk.let_go();
      return;
    case Fate::kPowerCut:
    case Fate::kKilled:
      disk.cut_power_after(any(20));
      return;
    case Fate::kClockSet:
      set_by_s =
          std::array<std::int64_t, 4>{-86'400, -5, 5, 3'600}[static_cast<std::size_t>(any(3))];
      return;
  }
}

// A stream of a replicate: adds what became of its samples.
void audit(const recording::Rows& rows, const v1::StreamIntegrity& verified, Tally& to) {
  ASSERT_EQ(verified.stored(), rows.size());
  const auto& numbers = std::get<std::vector<std::int64_t>>(rows.channels[0]);
  std::uint64_t refused = 0;
  for (const v1::RefusalCount& one : verified.refused()) refused += one.samples();
  for (std::size_t i = 1; i < numbers.size(); ++i) ASSERT_GT(numbers[i], numbers[i - 1]);
  const auto sent = static_cast<std::uint64_t>(numbers.back() - numbers.front()) + 1;
  EXPECT_EQ(sent, rows.size() + refused + verified.lost()) << verified.ShortDebugString();
  to.sent += sent;
  to.stored += rows.size();
  to.refused += refused;
  to.lost += verified.lost();
}

void audit(FakeDisk& disk, const std::filesystem::path& folder, Tally& to) {
  ASSERT_TRUE(recording::recover_recording(disk, folder, recording::Recovery::kUnsettled));
  const auto report = recording::verify_recording(disk, folder, false);
  const auto manifest = recording::read_manifest(disk, folder);
  ASSERT_TRUE(report && manifest && *manifest);
  EXPECT_TRUE(report->sound()) << report->DebugString();
  std::set<std::uint32_t> complete;
  for (const v1::ReplicateNote& note : (*manifest)->replicates()) {
    if (note.state() == v1::complete) complete.insert(note.replicate());
    ++(note.state() == v1::complete ? to.complete : to.interrupted);
    EXPECT_NE(note.state(), v1::open);
    for (const v1::StreamCount& count : note.streams()) to.not_written += count.not_written();
  }
  const auto devices = recording::find_device_folders(disk, folder);
  ASSERT_TRUE(devices);
  for (const recording::DeviceFolder& where : *devices) {
    const auto device = recording::read_device(disk, where, **manifest);
    ASSERT_TRUE(device) << device.error().message;
    EXPECT_TRUE(device->defects.empty()) << device->defects.front();
    for (const v1::StreamIntegrity& one : report->streams()) {
      if (one.replicate() != where.replicate() || one.device() != where.device()) continue;
      if (one.received() > 0) {
        audit(device->streams[0], one, to);
      } else {  // the disk failed before it had begun
        EXPECT_FALSE(complete.contains(one.replicate())) << one.ShortDebugString();
      }
    }
  }
}

int asked(const char* variable, int otherwise) {
  const char* const text = std::getenv(variable);  // NOLINT(concurrency-mt-unsafe)
  return text == nullptr ? otherwise : std::atoi(text);
}

TEST_F(ThirtyDays, EverySampleIsAccountedFor) {
  const int first = asked("IMUNOISE_FIRST_SEED", 1);
  const int days = asked("IMUNOISE_DAYS", 30);
  std::map<Fate, Tally> tallies;
  for (int day = first; day < first + days; ++day) {
    std::mt19937_64 random(static_cast<std::uint64_t>(day));
    const auto fate = static_cast<Fate>(day % static_cast<int>(kFates.size()));
    SCOPED_TRACE("day " + std::to_string(day) + ": " + kFates[static_cast<std::size_t>(fate)]);
    FakeDisk disk;
    const v1::Campaign campaign = campaign_of(day);
    {
      const auto moment = std::chrono::duration<double>(
          std::uniform_real_distribution<double>(0.1, 0.8 * kLengthS * kReplicates)(random));
      const std::jthread doom([&](const std::stop_token& stop) {
        for (const auto end = std::chrono::steady_clock::now() + moment;
             !stop.stop_requested() && std::chrono::steady_clock::now() < end;)
          std::this_thread::sleep_for(10ms);
        if (!stop.stop_requested()) befall(fate, disk, random);
      });
      const bool cut = fate == Fate::kPowerCut || fate == Fate::kKilled;
      EXPECT_EQ(run(campaign, disk), !cut);
    }
    if (fate == Fate::kPowerCut) disk.restore_power(FakeDisk::Unsynced::kAny, random());
    if (fate == Fate::kKilled) disk.restore_power(FakeDisk::Unsynced::kKept, random());
    disk.heal();
    set_by_s = 0;
    if (fate == Fate::kPowerCut || fate == Fate::kKilled) {
      EXPECT_TRUE(run(campaign, disk));
    }
    for (const std::filesystem::path& folder : recordings_on(disk))
      audit(disk, folder, tallies[fate]);
    if (HasFailure()) break;
  }
  std::cout << "seeds " << first << " to " << first + days - 1 << "\n";
  Tally all;
  for (const auto& [fate, one] : tallies) {
    std::cout << kFates[static_cast<std::size_t>(fate)] << ": " << one.complete << " complete, "
              << one.interrupted << " interrupted; sent " << one.sent << " = stored " << one.stored
              << " + refused " << one.refused << " + lost " << one.lost << "; not written "
              << one.not_written << "\n";
    all.sent += one.sent;
    all.stored += one.stored;
    all.refused += one.refused;
    all.lost += one.lost;
  }
  std::cout << "all: sent " << all.sent << " = stored " << all.stored << " + refused "
            << all.refused << " + lost " << all.lost << "\n";
}

}  // namespace
}  // namespace imunoise::acquire
