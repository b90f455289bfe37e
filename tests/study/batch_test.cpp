// Batches: how they are cut, what a folder says of them, and that simulations do not depend on the
// cut.

#include <gtest/gtest.h>

#include <cmath>
#include <fstream>
#include <iterator>

#include "study/batch/batch_folder.h"
#include "study/batch/batch_plan.h"
#include "study/batch/merge.h"
#include "study/batch/run_shard.h"
#include "study/calibration/calibrate.h"
#include "study/calibration/calibration_file.h"
#include "tests/study/simulated_recording.h"

namespace imunoise::study {
namespace {

namespace fs = std::filesystem;

recording::FileSystem& files() { return recording::posix_file_system(); }

std::string read(const fs::path& path) {
  std::ifstream file(path);
  return {std::istreambuf_iterator<char>(file), {}};
}

v1::Batch simulations(std::uint32_t sets, std::uint32_t shard_size) {
  v1::Batch out;
  out.set_version(kBatchVersion);
  out.set_shard_size(shard_size);
  v1::SimulationTask& task = *out.mutable_simulate();
  task.set_model("WN(sigma2=1e-6) + RW(gamma2=1e-10)");
  task.set_fit("WN + RW");
  task.set_rate_hz(100.0);
  task.set_samples(1024);
  task.set_replicates(2);
  task.set_sets(sets);
  task.set_seed(7);
  task.set_confidence(0.95);
  return out;
}

v1::Batch calibrations(const std::vector<fs::path>& recordings) {
  v1::Batch out;
  out.set_version(kBatchVersion);
  out.set_shard_size(1);
  v1::CalibrationTask& task = *out.mutable_calibrate();
  task.mutable_settings()->add_models("WN");
  task.mutable_settings()->set_seed(1);
  for (const fs::path& one : recordings) task.add_recordings(one.string());
  return out;
}

// What a worker does.
Result<void> work(const fs::path& folder, std::uint32_t number) {
  const auto shard = read_shard(files(), folder, number);
  if (!shard) return tl::unexpected(shard.error());
  auto result = run_shard(files(), shard->shard, 5);
  if (!result) return tl::unexpected(result.error());
  result->set_fingerprint(shard->fingerprint);
  return write_result(files(), folder, *result, "test");
}

void work_on_all(const fs::path& folder) {
  const auto status = batch_status(files(), folder);
  ASSERT_TRUE(status.has_value()) << status.error().message;
  for (const v1::ShardStatus& one : status->open()) {
    const auto done = work(folder, one.number());
    ASSERT_TRUE(done.has_value()) << done.error().message;
  }
}

TEST(BatchPlan, ShardsAreTheBatchInOrder) {
  const std::vector<v1::BatchShard> shards = shards_of(simulations(10, 4));
  ASSERT_EQ(shards.size(), 3U);
  std::uint32_t next = 0;
  for (std::uint32_t i = 0; i < shards.size(); ++i) {
    EXPECT_EQ(shards[i].number(), i);
    EXPECT_EQ(shards[i].simulate().first_set(), next);
    EXPECT_EQ(shards[i].simulate().seed(), 7U);
    next += shards[i].simulate().sets();
  }
  EXPECT_EQ(next, 10U);
  EXPECT_EQ(shards_of(calibrations({"/a", "/b"}))[1].calibrate().recordings(0), "/b");
}

TEST(BatchPlan, SaysWhatCannotBeDone) {
  const auto said = [](v1::Batch batch) {
    const auto good = check_batch(batch);
    return good ? "" : good.error().message;
  };
  EXPECT_EQ(said(simulations(1000, 1)), "");
  EXPECT_NE(said(simulations(1001, 1)).find("--shard-size 2"), std::string::npos);
  EXPECT_NE(said(calibrations({})).find("no recordings and no simulation"), std::string::npos);
  v1::Batch open = simulations(3, 1);
  open.mutable_simulate()->set_model("WN + RW");
  EXPECT_NE(said(open).find("leaves values open"), std::string::npos);
  v1::Batch wrong = calibrations({"/a"});
  wrong.mutable_calibrate()->mutable_settings()->add_models("WN + NONSENSE");
  EXPECT_NE(said(wrong).find("NONSENSE"), std::string::npos);
}

TEST(BatchPlan, ShardsAreFewUnlessTheUserSays) {
  EXPECT_EQ(default_shard_size(simulations(5, 1)), 1U);
  EXPECT_EQ(default_shard_size(simulations(100'000, 1)), 1000U);
  EXPECT_EQ(default_shard_size(calibrations({"/a", "/b"})), 1U);
  EXPECT_EQ(default_shard_size(calibrations(std::vector<fs::path>(2500, "/a"))), 3U);
}

TEST(BatchPlan, TheFormOfAModelHasNoValues) {
  EXPECT_EQ(*form_of("WN(sigma2=1e-6) + AR1(sigma2=1e-9, phi=0.99)", 100.0), "WN + AR1");
  EXPECT_FALSE(form_of("WN(", 100.0).has_value());
}

TEST(Batch, SimulationsDoNotDependOnTheCut) {
  const testing::TemporaryFolder room;
  std::string first;
  for (const std::uint32_t size : {1U, 2U, 5U, 9U}) {
    const fs::path folder = room.path() / std::to_string(size);
    ASSERT_TRUE(make_batch(files(), folder, simulations(9, size)).has_value());
    work_on_all(folder);
    const auto merged = merge_batch(files(), folder);
    ASSERT_TRUE(merged.has_value()) << merged.error().message;
    if (first.empty()) first = read(folder / kMergedName);
    EXPECT_EQ(read(folder / kMergedName), first) << size;
  }
  EXPECT_NE(first.find("\"rejected\""), std::string::npos);
}

TEST(Batch, SetsDiffer) {
  v1::BatchShard shard = shards_of(simulations(2, 2)).front();
  const auto result = run_shard(files(), shard, 0);
  ASSERT_TRUE(result.has_value());
  ASSERT_EQ(result->fits_size(), 2);
  EXPECT_NE(result->fits(0).terms(0).parameters(0).value(),
            result->fits(1).terms(0).parameters(0).value());
}

TEST(Batch, ASummaryComparesWithTheTruth) {
  v1::Batch batch = simulations(40, 40);
  const auto result = run_shard(files(), shards_of(batch).front(), 0);
  ASSERT_TRUE(result.has_value());
  const v1::SimulationSummary summary = summarise(batch.simulate(), {*result});
  ASSERT_EQ(summary.parameters_size(), 2);
  const v1::SimulatedParameter& sigma2 = summary.parameters(0);
  EXPECT_EQ(sigma2.truth(), 1e-6);
  EXPECT_EQ(sigma2.seen(), 40U);
  // 2 · 1024 samples: the standard deviation of σ̂² is about σ²·√(3/2048), of the mean √40 less.
  EXPECT_NEAR(sigma2.mean(), 1e-6, 5.0 * sigma2.deviation() / std::sqrt(40.0));
  EXPECT_GT(sigma2.deviation(), 1e-8);
  EXPECT_LT(sigma2.deviation(), 2e-7);
  EXPECT_GT(sigma2.covered(), 0.8);
  EXPECT_EQ(summary.tested(), 40U);
  EXPECT_LT(summary.rejected(), 10U);

  batch.mutable_simulate()->set_fit("WN");
  const auto other = run_shard(files(), shards_of(batch).front(), 0);
  ASSERT_TRUE(other.has_value());
  EXPECT_FALSE(summarise(batch.simulate(), {*other}).parameters(0).has_truth());
}

TEST(Batch, AShardIsDoneWhenItsResultCanBeRead) {
  const testing::TemporaryFolder room;
  const fs::path folder = room.path() / "batch";
  ASSERT_TRUE(make_batch(files(), folder, simulations(3, 1)).has_value());
  EXPECT_EQ(batch_status(files(), folder)->open_size(), 3);
  EXPECT_NE(merge_batch(files(), folder).error().message.find("3 of 3 shards"), std::string::npos);
  work_on_all(folder);
  EXPECT_EQ(batch_status(files(), folder)->done(), 3U);

  const fs::path results = folder / "results";
  const std::string whole = read(results / "000001.json");
  for (const std::string& bad :
       {std::string(), whole.substr(0, whole.size() / 2), read(results / "000000.json")}) {
    std::ofstream(results / "000001.json") << bad;
    const auto status = batch_status(files(), folder);
    ASSERT_EQ(status->open_size(), 1) << bad.substr(0, 20);
    EXPECT_EQ(status->open(0).number(), 1U);
    EXPECT_EQ(status->open(0).state(), v1::damaged);
    EXPECT_NE(status->open(0).trouble().find("000001.json"), std::string::npos);
    EXPECT_FALSE(merge_batch(files(), folder).has_value());
  }
  work_on_all(folder);
  EXPECT_EQ(read(results / "000001.json"), whole);
}

TEST(Batch, TellsTheEndOfALog) {
  const testing::TemporaryFolder room;
  const fs::path folder = room.path() / "batch";
  ASSERT_TRUE(make_batch(files(), folder, simulations(1, 1)).has_value());
  std::ofstream(log_path(folder, 0)) << "1\n2\n3\n\n4\n5\n6\n7";
  const auto status = batch_status(files(), folder);
  ASSERT_EQ(status->open(0).log_size(), 5);
  EXPECT_EQ(status->open(0).log(0), "3");
  EXPECT_EQ(status->open(0).log(4), "7");
}

TEST(Batch, IsMadeOnceAndReadStrictly) {
  const testing::TemporaryFolder room;
  const fs::path folder = room.path() / "batch";
  EXPECT_NE(batch_status(files(), room.path()).error().message.find("contains no batch"),
            std::string::npos);
  ASSERT_TRUE(make_batch(files(), folder, simulations(3, 1)).has_value());
  EXPECT_NE(make_batch(files(), folder, simulations(3, 1)).error().message.find("contains a batch"),
            std::string::npos);
  EXPECT_FALSE(read_shard(files(), folder, 3).has_value());
  std::ofstream(folder / "shards" / "000000.json") << R"({"version": 2})";
  EXPECT_NE(read_shard(files(), folder, 0).error().message.find("version 2"), std::string::npos);
}

TEST(Batch, CalibrationsLieBesideTheirRecordings) {
  const testing::TemporaryFolder room;
  std::vector<fs::path> recordings;
  for (const char* const name : {"one", "two"}) {
    testing::SimulatedRecording what;
    what.folder = recordings.emplace_back(room.path() / name);
    what.channels = {{"gyro_x", "rad/s", "WN(sigma2=1e-6)"}};
    what.samples = 1024;
    testing::record(what);
  }
  const fs::path folder = room.path() / "batch";
  ASSERT_TRUE(make_batch(files(), folder, calibrations(recordings)).has_value());
  work_on_all(folder);
  EXPECT_FALSE(fs::exists(recordings[0] / kCalibrationName));  // only merging writes it
  const auto merged = merge_batch(files(), folder);
  ASSERT_TRUE(merged.has_value()) << merged.error().message;
  ASSERT_EQ(merged->calibrations_size(), 2);
  for (const fs::path& recording : recordings) {
    CalibrateOptions options;
    options.models = {"WN"};
    options.diagnose = false;
    options.made_ns = 5;
    const auto alone = calibrate(files(), recording, options);
    const auto kept = read_calibration(files(), recording);
    ASSERT_TRUE(alone.has_value() && kept.has_value() && kept->has_value());
    EXPECT_TRUE((*kept)->channels(0).SerializeAsString() == alone->channels(0).SerializeAsString());
    EXPECT_EQ((*kept)->made_ns(), 5);
  }
}

}  // namespace
}  // namespace imunoise::study
