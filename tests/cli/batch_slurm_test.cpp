// `imunoise batch run --engine slurm` on a real Slurm of one node.

#include <future>
#include <nlohmann/json.hpp>

#include "tests/cli/program.h"
#include "tests/cli/slurm_cluster.h"

namespace imunoise {
namespace {

using nlohmann::json;
using testing::Outcome;

class SlurmBatches : public testing::Program {
 protected:
  void SetUp() override {
    if (!cluster_.trouble().empty()) GTEST_SKIP() << "SKIPPED: " << cluster_.trouble();
  }
  // Eight sets in shards of this many.
  void make(const std::string& folder, int shard_size, int samples) const {
    const Outcome made =
        run("batch new " + folder +
            " --simulate 'WN(sigma2=1e-6) + AR1(sigma2=1e-9, phi=0.99)' --rate 100 --samples " +
            std::to_string(samples) + " --replicates 2 --sets 8 --seed 3 --shard-size " +
            std::to_string(shard_size));
    ASSERT_EQ(made.status, 0) << made.errors;
  }
  int shell(const std::string& script) const {
    return WEXITSTATUS(std::system(("cd '" + folder_.string() + "' && " + script).c_str()));
  }
  // Until a task runs.
  void wait_for_a_task() const {
    ASSERT_EQ(
        shell("timeout 60 sh -c 'until squeue -h -t RUNNING | grep -q .; do sleep 0.1; done'"), 0);
  }

  testing::SlurmCluster cluster_;
};

TEST_F(SlurmBatches, AreTheSameAsHere) {
  make("here", 8, 20000);
  make("there", 2, 20000);
  ASSERT_EQ(run("batch run here").status, 0);
  const Outcome there = run("batch run there --engine slurm --workers 2");
  ASSERT_EQ(there.status, 0) << there.errors << there.out;
  EXPECT_EQ(read("there/merged.json"), read("here/merged.json"));
}

TEST_F(SlurmBatches, ALostNodesShardsRunAgain) {
  make("here", 8, 2'000'000);
  make("there", 4, 2'000'000);
  ASSERT_EQ(run("batch run here").status, 0);
  auto running = std::async(std::launch::async,
                            [&] { return run("batch run there --engine slurm 2>slurm.txt"); });
  wait_for_a_task();
  EXPECT_TRUE(cluster_.lose_node());
  const Outcome done = running.get();
  ASSERT_EQ(done.status, 0) << done.errors << done.out;
  EXPECT_EQ(read("there/merged.json"), read("here/merged.json"));
}

TEST_F(SlurmBatches, ACancelledTasksShardIsSubmittedAgain) {
  make("there", 4, 2'000'000);
  auto running =
      std::async(std::launch::async, [&] { return run("batch run there --engine slurm"); });
  wait_for_a_task();
  EXPECT_EQ(shell("scancel $(squeue -h -r -t RUNNING -o %i | head -n 1)"), 0);
  const Outcome done = running.get();
  ASSERT_EQ(done.status, 0) << done.errors << done.out;
  EXPECT_EQ(json::parse(run("batch status there --json").out)["done"], 2);
}

TEST_F(SlurmBatches, WhatFailsAgainAndAgainIsTold) {
  make("there", 4, 20000);
  ASSERT_EQ(shell("printf '{' > there/shards/000001.json"), 0);
  const Outcome done = run("batch run there --engine slurm --retries 1");
  EXPECT_EQ(done.status, 1);
  EXPECT_NE(done.out.find("1 of 2 shards are complete"), std::string::npos) << done.out;
  EXPECT_NE(done.out.find("not a shard"), std::string::npos) << done.out;
  const std::string log = read("there/log/000001.txt");
  EXPECT_NE(log.find("not a shard"), log.rfind("not a shard")) << "tried twice: " << log;
}

}  // namespace
}  // namespace imunoise
