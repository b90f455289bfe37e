// Who runs a batch: rounds, child processes, and Slurm as its programs' words tell it.

#include <gtest/gtest.h>

#include <algorithm>
#include <chrono>
#include <cstdlib>
#include <fstream>
#include <iterator>
#include <thread>

#include "daemon/batch/slurm_engine.h"
#include "daemon/process/child.h"
#include "study/batch/batch_folder.h"
#include "study/batch/batch_plan.h"
#include "tests/study/simulated_recording.h"

namespace imunoise::batch {
namespace {

namespace fs = std::filesystem;
using namespace std::chrono_literals;

recording::FileSystem& files() { return recording::posix_file_system(); }

std::string read(const fs::path& path) {
  std::ifstream file(path);
  return {std::istreambuf_iterator<char>(file), {}};
}

// A batch of simulations of this many shards, in a folder of its own.
class Batches : public ::testing::Test {
 protected:
  Batches() {
    v1::Batch batch;
    batch.set_version(study::kBatchVersion);
    batch.set_shard_size(1);
    v1::SimulationTask& task = *batch.mutable_simulate();
    task.set_model("WN(sigma2=1)");
    task.set_fit("WN");
    task.set_rate_hz(1.0);
    task.set_samples(64);
    task.set_replicates(1);
    task.set_sets(4);
    worker_ = {"/bin/false", room_.path() / "batch"};
    EXPECT_TRUE(study::make_batch(files(), worker_.folder, batch).has_value());
  }
  void finish(std::uint32_t number) const {
    v1::ShardResult result;
    result.set_version(study::kBatchVersion);
    result.set_shard(number);
    result.set_fingerprint(study::read_shard(files(), worker_.folder, number)->fingerprint);
    EXPECT_TRUE(study::write_result(files(), worker_.folder, result, "test").has_value());
  }

  testing::TemporaryFolder room_;
  Worker worker_;
};

// Finishes all shards but one, which it loses so many times.
class LosingEngine final : public Engine {
 public:
  LosingEngine(std::function<void(std::uint32_t)> finish, int losses)
      : finish_(std::move(finish)), losses_(losses) {}
  Result<void> run(const std::vector<std::uint32_t>& shards,
                   const std::function<bool()>& go_on) override {
    asked.push_back(shards);
    if (!go_on()) return {};
    for (const std::uint32_t shard : shards) {
      if (shard != 2 || losses_-- <= 0) finish_(shard);
    }
    return {};
  }
  std::vector<std::vector<std::uint32_t>> asked;

 private:
  std::function<void(std::uint32_t)> finish_;
  int losses_;
};

TEST_F(Batches, LostShardsRunAgain) {
  LosingEngine engine([this](std::uint32_t shard) { finish(shard); }, 2);
  finish(0);
  const auto status = run_batch(files(), worker_, engine, 3, {});
  ASSERT_TRUE(status.has_value()) << status.error().message;
  EXPECT_EQ(status->done(), 4U);
  const std::vector<std::vector<std::uint32_t>> expected = {{1, 2, 3}, {2}, {2}};
  EXPECT_EQ(engine.asked, expected);
}

TEST_F(Batches, AreGivenUpAfterTheLastRetry) {
  LosingEngine engine([this](std::uint32_t shard) { finish(shard); }, 9);
  const auto status = run_batch(files(), worker_, engine, 1, {});
  ASSERT_TRUE(status.has_value());
  EXPECT_EQ(engine.asked.size(), 2U);
  ASSERT_EQ(status->open_size(), 1);
  EXPECT_EQ(status->open(0).number(), 2U);
}

TEST_F(Batches, StopWhenAskedAndAreRunByOneAtATime) {
  std::stop_source stop;
  stop.request_stop();
  LosingEngine engine([](std::uint32_t) {}, 0);
  const auto stopped =
      run_batch(files(), worker_, engine, 3, Progress([](double) {}, stop.get_token()));
  ASSERT_FALSE(stopped.has_value());
  EXPECT_NE(stopped.error().message.find("run it again"), std::string::npos);
  EXPECT_EQ(engine.asked.size(), 1U);

  const auto lock = files().lock(worker_.folder);
  const auto second = run_batch(files(), worker_, engine, 3, {});
  ASSERT_FALSE(second.has_value());
  EXPECT_NE(second.error().message.find("another"), std::string::npos);
}

TEST(Child, SaysItsSignalAndKeepsItsWords) {
  const testing::TemporaryFolder room;
  const fs::path log = room.path() / "log";
  auto child = process::Child::start({"sh", "-c", "echo out; echo err >&2; kill -9 $$"}, log);
  ASSERT_TRUE(child.has_value()) << child.error().message;
  while (!child->ended()) std::this_thread::sleep_for(5ms);
  EXPECT_EQ(child->signal(), 9);
  EXPECT_EQ(read(log), "out\nerr\n");
  EXPECT_FALSE(process::Child::start({"/no/such/program"}, log).has_value());
}

TEST(Child, IsEndedWithItsOwner) {
  const testing::TemporaryFolder room;
  const auto begin = std::chrono::steady_clock::now();
  {
    auto child = process::Child::start({"sleep", "60"}, room.path() / "log");
    ASSERT_TRUE(child.has_value());
  }
  EXPECT_LT(std::chrono::steady_clock::now() - begin, 30s);
}

TEST(Child, IsAskedForItsWords) {
  const auto said = process::ask({"sh", "-c", "echo out; echo err >&2; exit 3"});
  ASSERT_TRUE(said.has_value());
  EXPECT_EQ(said->status, 3);
  EXPECT_EQ(said->text, "out\nerr\n");
  EXPECT_FALSE(process::ask({"/no/such/program"}).has_value());
}

TEST(Slurm, ArraysAreRanges) {
  EXPECT_EQ(array_text({0}), "0");
  EXPECT_EQ(array_text({0, 1, 2, 5, 7, 8}), "0-2,5,7-8");
}

TEST(Slurm, QueueSaysWhatIsLeft) {
  const Queue queue = queue_of(
      "PENDING|Resources\nPENDING|launch failed requeued held\nPENDING|JobHeldAdmin\nRUNNING|None\n"
      "COMPLETING|None\nCOMPLETED|None\nFAILED|NonZeroExitCode\nNODE_FAIL|None\n");
  EXPECT_EQ(queue.waiting, 3U);
  EXPECT_EQ(queue.held, 2U);
  EXPECT_EQ(queue.running, 2U);
  EXPECT_EQ(queue_of("").running, 0U);
}

// Programs of Slurm's names, which write down how they were called.
class FakeSlurm : public Batches {
 protected:
  FakeSlurm() : path_(std::getenv("PATH")) {
    fs::create_directory(bin());
    ::setenv("PATH", (bin().string() + ":" + path_).c_str(), 1);
  }
  ~FakeSlurm() override { ::setenv("PATH", path_.c_str(), 1); }
  fs::path bin() const { return room_.path() / "bin"; }
  void program(const std::string& name, const std::string& script) const {
    std::ofstream(bin() / name) << "#!/bin/sh\necho \"$0 $*\" >> '" << room_.path().string()
                                << "/calls'\n"
                                << script << "\n";
    fs::permissions(bin() / name, fs::perms::owner_all);
  }
  std::string calls() const { return read(room_.path() / "calls"); }
  SlurmEngine engine() const { return {worker_, 2, {"--partition=long"}, 5ms}; }

 private:
  std::string path_;
};

TEST_F(FakeSlurm, IsAskedForAnArrayAndWaitedFor) {
  program("sbatch", "echo '17;cluster'");
  program("squeue", "test $(grep -c squeue '" + (room_.path() / "calls").string() +
                        "') -lt 3 && echo 'RUNNING|None'\nexit 0");
  SlurmEngine slurm = engine();
  const auto done = slurm.run({0, 1, 3}, [] { return true; });
  ASSERT_TRUE(done.has_value()) << done.error().message;
  const std::string said = calls();
  EXPECT_NE(said.find("--array=0-1,3%2 --partition=long"), std::string::npos) << said;
  EXPECT_NE(said.find("--jobs=17 "), std::string::npos) << said;
  EXPECT_EQ(said.find("scancel"), std::string::npos) << said;
  EXPECT_NE(read(worker_.folder / "shard.sh").find("batch shard"), std::string::npos);
}

TEST_F(FakeSlurm, ForgottenJobsAreOverAndHeldOnesGivenUp) {
  program("sbatch", "echo 17");
  program("scancel", "");
  program("squeue", "echo 'slurm_load_jobs error: Invalid job id specified'; exit 1");
  SlurmEngine slurm = engine();
  EXPECT_TRUE(slurm.run({0}, [] { return true; }).has_value());
  EXPECT_EQ(calls().find("scancel"), std::string::npos);
  program("squeue", "echo 'PENDING|launch failed requeued held'");
  EXPECT_TRUE(slurm.run({0}, [] { return true; }).has_value());
  EXPECT_NE(calls().find("scancel 17"), std::string::npos);
}

TEST_F(FakeSlurm, AJobIsCancelledWithItsOwnerAndARefusalTold) {
  program("sbatch", "echo 17");
  program("squeue", "echo 'RUNNING|None'");
  program("scancel", "");
  SlurmEngine slurm = engine();
  EXPECT_TRUE(slurm.run({0}, [] { return false; }).has_value());
  EXPECT_NE(calls().find("scancel 17"), std::string::npos);
  program("sbatch", "echo 'sbatch: error: invalid partition specified: long' >&2; exit 1");
  const auto refused = slurm.run({0}, [] { return true; });
  ASSERT_FALSE(refused.has_value());
  EXPECT_NE(refused.error().message.find("invalid partition"), std::string::npos);
}

}  // namespace
}  // namespace imunoise::batch
