// What the start of a replicate does with those before it.

#include <gtest/gtest.h>

#include <array>

#include "recording/store/format/layout.h"
#include "recording/store/manifest/manifest.h"
#include "recording/store/manifest/replicate_set.h"
#include "recording/store/recorder/recorder.h"
#include "recording/store/verify/verify.h"
#include "tests/recording/files.h"
#include "tests/recording/store/fake_disk.h"
#include "tests/recording/store/samples.h"

namespace imunoise::recording {
namespace {

RecordingPlan replicate_plan(std::uint32_t replicate) {
  RecordingPlan out{"bench", replicate, kStart, {test_device()}};
  out.note = v1::ReplicateNote();
  return out;
}

// What was closed is not read again: the hundredth replicate starts as quickly as the second.
TEST(StartOfAReplicate, ReadsNothingOfClosedReplicates) {
  FakeDisk disk;
  using Call = FakeDisk::Call;
  using Cost = std::array<std::uint64_t, 4>;  // of a start
  const auto cost = [&] {
    return Cost{static_cast<std::uint64_t>(disk.calls(Call::kRead)),
                static_cast<std::uint64_t>(disk.calls(Call::kList)), disk.bytes_read(),
                disk.bytes_written()};
  };
  std::vector<Cost> costs;
  for (std::uint32_t replicate = 1; replicate <= 20; ++replicate) {
    const RecordingPlan next = replicate_plan(replicate);
    const Cost before = cost();
    const auto recorder = Recorder::start(disk, "/run", next, {});
    ASSERT_TRUE(recorder) << recorder.error().message;
    Cost& taken = costs.emplace_back(cost());
    for (std::size_t i = 0; i < taken.size(); ++i) taken[i] -= before[i];
    ASSERT_TRUE((*recorder)->push(0, imu_block(0, 100)));
    v1::ReplicateNote note;
    note.set_state(v1::complete);
    ASSERT_TRUE((*recorder)->close([&](const auto&) { return note; }));
  }
  EXPECT_EQ(costs[1][0], 1U) << "the manifest";
  EXPECT_EQ(costs[18][0], costs[1][0]) << "reads";
  EXPECT_EQ(costs[18][1], 1U) << "lists its own folder, not that of all replicates";
  EXPECT_LE(costs[18][2], costs[1][2] + 2) << "bytes read: two numbers have a digit more";
  EXPECT_LE(costs[18][3], costs[1][3] + 10) << "bytes written";
  EXPECT_TRUE(verify_recording(disk, "/run", false)->sound());
}

// A replicate that was not settled is looked at before the next one starts, whichever it is.
TEST(StartOfAReplicate, FindsTheReplicateThatIsNotSettled) {
  for (const std::uint32_t open : {1U, 2U, 3U}) {
    SCOPED_TRACE(open);
    FakeDisk disk;
    for (std::uint32_t replicate = 1; replicate <= 3; ++replicate) {
      const auto recorder = Recorder::start(disk, "/run", replicate_plan(replicate), {});
      ASSERT_TRUE(recorder) << recorder.error().message;
      EXPECT_TRUE((*recorder)->repaired().empty());
      ASSERT_TRUE((*recorder)->push(0, imu_block(0, 100)));
      ASSERT_TRUE((*recorder)->close());
    }
    const std::filesystem::path file = std::filesystem::path("/run") / kManifestName;
    auto manifest = parse_recording_manifest(file.string(), disk.read(file).value());
    ASSERT_TRUE(manifest && manifest->recording.closed());
    erase(*manifest->recording.mutable_settled(), open);
    disk.overwrite(file, print_manifest(manifest->recording));
    const std::string chunk = replicate_folder(open) + "/imu0/000001.h5";
    ASSERT_TRUE(disk.remove("/run/" + chunk));
    const auto recorder = Recorder::start(disk, "/run", replicate_plan(4));
    ASSERT_TRUE(recorder) << recorder.error().message;
    ASSERT_FALSE((*recorder)->repaired().empty());
    expect_parts((*recorder)->repaired().front(), {chunk, "is missing"});
  }
}

}  // namespace
}  // namespace imunoise::recording
