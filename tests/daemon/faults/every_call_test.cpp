// A whole campaign, from its first folder to the end, while one or two calls of its disk fail: it
// comes to its end, and what it says of its recordings is true.

#include <algorithm>
#include <array>
#include <cstdlib>
#include <iostream>
#include <random>

#include "recording/store/manifest/device_folder.h"
#include "recording/store/manifest/manifest.h"
#include "recording/store/recovery/recover.h"
#include "recording/store/verify/verify.h"
#include "tests/daemon/faults/run_once.h"
#include "tests/daemon/whims.h"
#include "tests/recording/store/fake_disk.h"

namespace imunoise::acquire {
namespace {

using namespace std::chrono_literals;
using recording::FakeDisk;
using Call = FakeDisk::Call;

const std::filesystem::path kRoot = "/bench/here";
constexpr std::uint32_t kReplicates = 2;

class EveryCallOfACampaign : public testing::Whims {
 protected:
  EveryCallOfACampaign() {
    campaign_.set_name("bench");
    campaign_.set_folder(kRoot.string());
    campaign_.set_replicates(kReplicates);
    campaign_.set_length_s(0.03);
    campaign_.set_patience_s(5.0);
    for (const std::string name : {"a", "b"}) {
      tell(name, "here");
      v1::CampaignDevice& device = *campaign_.add_devices();
      device.set_name(name);
      device.set_driver("whims");
      v1::CampaignOption& file = *device.add_options();
      file.set_name("file");
      file.set_value(word_of(name).string());
    }
  }

  // Whether it came to its end by itself.
  bool run(FakeDisk& disk) const { return testing::run_once(campaign_, drivers(), disk); }

  // How often a campaign whose disk never fails calls it, by kind.
  std::array<int, FakeDisk::kKinds> calls_of_a_run() const {
    FakeDisk disk;
    EXPECT_TRUE(run(disk));
    std::array<int, FakeDisk::kKinds> out{};
    for (int kind = 0; kind < FakeDisk::kKinds; ++kind)
      out[static_cast<std::size_t>(kind)] = disk.calls(static_cast<Call>(kind));
    return out;
  }

  v1::Campaign campaign_;
};

// A number in the environment asks for more than the tests do by themselves.
int asked(const char* variable, int otherwise) {
  const char* const text = std::getenv(variable);  // NOLINT(concurrency-mt-unsafe)
  return text == nullptr ? otherwise : std::atoi(text);
}

std::uint64_t discarded(const v1::StreamCount& count) {
  std::uint64_t out = 0;
  for (const v1::RefusalCount& one : count.discarded()) out += one.samples();
  return out;
}

// Rows of a stream that are on the disk.
std::uint64_t rows_there(const v1::VerifyReport& report, std::uint32_t replicate,
                         const v1::StreamCount& count) {
  std::uint64_t out = 0;
  for (const v1::StreamIntegrity& one : report.streams()) {
    const bool same = one.replicate() == replicate && one.device() == count.device() &&
                      one.stream() == count.stream();
    if (same) out += one.stored() + one.in_journal();
  }
  return out;
}

void expect_only_journals_aside(const FakeDisk& disk, const std::filesystem::path& folder) {
  EXPECT_FALSE(recording::contains(disk, folder, "manifest.json.broken").value());
  const auto folders = recording::find_device_folders(disk, folder).value();
  for (const recording::DeviceFolder& where : folders) {
    const auto names = recording::list_device_files(disk, where);
    ASSERT_TRUE(names);
    for (const std::string& name : names->broken)
      EXPECT_NE(name.find(".journal"), std::string::npos) << where.folder << ": " << name;
  }
}

// What a recording whose accounts are true says of itself.
struct Account {
  std::uint32_t complete = 0;  // replicates
  std::uint64_t not_written = 0;
};

Account audited(FakeDisk& disk, const std::filesystem::path& folder) {
  Account out;
  EXPECT_TRUE(recording::recover_recording(disk, folder, recording::Recovery::kUnsettled));
  const auto report = recording::verify_recording(disk, folder, false);
  const auto manifest = recording::read_manifest(disk, folder);
  EXPECT_TRUE(report && manifest && *manifest);
  if (!report || !manifest || !*manifest) return out;
  EXPECT_TRUE(report->sound()) << report->DebugString();
  for (const v1::ReplicateNote& note : (*manifest)->replicates()) {
    if (note.state() == v1::complete) {
      ++out.complete;
      EXPECT_EQ(note.streams_size(), 2);
    }
    for (const v1::StreamCount& count : note.streams()) {
      out.not_written += count.not_written();
      EXPECT_EQ(count.received(), count.stored() + discarded(count) + count.not_written());
      const std::uint64_t there = rows_there(*report, note.replicate(), count);
      EXPECT_GE(there, count.stored());
      if (note.state() == v1::complete) {
        EXPECT_EQ(there, count.received()) << note.DebugString();
        EXPECT_GE(there, 1U);
      }
    }
  }
  expect_only_journals_aside(disk, folder);
  return out;
}

// Of a campaign at its end: samples that are on record as not written.
std::uint64_t audited_campaign(FakeDisk& disk) {
  Account all;
  const std::vector<std::string> recordings = disk.list(kRoot).value();
  for (const std::string& name : recordings) {
    const Account one = audited(disk, kRoot / name.substr(0, name.size() - 1));
    all.complete += one.complete;
    all.not_written += one.not_written;
  }
  EXPECT_EQ(all.complete, kReplicates);
  return all.not_written;
}

TEST_F(EveryCallOfACampaign, FailsOnceAndTheCampaignTellsTheTruth) {
  int runs = 0;
  for (int kind = 0; kind < FakeDisk::kKinds; ++kind) {
    for (int nth = 1 + kind % IMUNOISE_EVERY_NTH;; nth += IMUNOISE_EVERY_NTH, ++runs) {
      SCOPED_TRACE("kind " + std::to_string(kind) + ", call " + std::to_string(nth));
      FakeDisk disk;
      disk.fail_once(static_cast<Call>(kind), nth);
      EXPECT_TRUE(run(disk));
      if (!disk.failed()) break;  // it never comes
      disk.heal();
      audited_campaign(disk);
      if (HasFailure()) return;
    }
  }
  std::cout << runs << " calls failed once\n";
  EXPECT_GT(runs, 100 / IMUNOISE_EVERY_NTH);
}

// Any two calls of the campaign, each as likely as every other; half of them were carried out
// although they return an error. IMUNOISE_PAIRS and IMUNOISE_FIRST_SEED ask for more, in parts.
TEST_F(EveryCallOfACampaign, RandomPairsFailAndTheCampaignTellsTheTruth) {
  const std::array<int, FakeDisk::kKinds> calls = calls_of_a_run();
  const int first = asked("IMUNOISE_FIRST_SEED", 1);
  const int last = first + asked("IMUNOISE_PAIRS", 160 / IMUNOISE_EVERY_NTH) - 1;
  std::uint64_t not_written = 0;
  for (int seed = first; seed <= last; ++seed) {
    std::mt19937_64 random(static_cast<std::uint64_t>(seed));
    FakeDisk disk;
    std::string trace = "seed " + std::to_string(seed);
    for (int k = 0; k < 2; ++k) {
      const int kind = std::discrete_distribution<int>(calls.begin(), calls.end())(random);
      const int nth =
          std::uniform_int_distribution<int>(1, calls[static_cast<std::size_t>(kind)])(random);
      const bool done = random() % 2 == 0;
      disk.fail_once(static_cast<Call>(kind), nth, done);
      trace +=
          ", kind " + std::to_string(kind) + " call " + std::to_string(nth) + (done ? " done" : "");
    }
    SCOPED_TRACE(trace);
    EXPECT_TRUE(run(disk));
    disk.heal();
    not_written += audited_campaign(disk);
    if (HasFailure()) return;
  }
  std::cout << "seeds " << first << " to " << last << "; " << not_written
            << " samples reported as not written\n";
}

// Longer than the recorder tries at its close: what is left in journals becomes chunks before the
// campaign goes on.
TEST_F(EveryCallOfACampaign, FailsForAWhileAndTheRecordingIsClosed) {
  constexpr int kWhile = 6;
  int runs = 0;
  for (const Call kind : {Call::kCreate, Call::kSync, Call::kRename}) {
    for (int nth = 1;; nth += IMUNOISE_EVERY_NTH / 4 + 1, ++runs) {
      SCOPED_TRACE("kind " + std::to_string(static_cast<int>(kind)) + ", call " +
                   std::to_string(nth));
      FakeDisk disk;
      for (int k = 0; k < kWhile; ++k) disk.fail_once(kind, nth + k);
      EXPECT_TRUE(run(disk));
      if (!disk.failed()) break;
      disk.heal();
      const std::vector<std::string> recordings = disk.list(kRoot).value();
      for (const std::string& name : recordings) {
        const std::filesystem::path folder = kRoot / name.substr(0, name.size() - 1);
        EXPECT_TRUE(recording::read_manifest(disk, folder).value().value().closed());
      }
      audited_campaign(disk);
      if (HasFailure()) return;
    }
  }
  std::cout << runs << " times calls failed for a while\n";
  EXPECT_GT(runs, 5);
}

}  // namespace
}  // namespace imunoise::acquire
