// `imunoise batch` as a user runs it, on this machine.

#include <nlohmann/json.hpp>

#include "tests/cli/program.h"
#include "tests/study/simulated_recording.h"

namespace imunoise {
namespace {

using nlohmann::json;
using testing::Outcome;

class BatchCommands : public testing::Program {
 protected:
  // Eight sets of two replicates.
  void make(const std::string& folder, const std::string& more = "", int samples = 20000) const {
    const Outcome made = run("batch new " + folder +
                             " --simulate 'WN(sigma2=1e-6) + AR1(sigma2=1e-9, phi=0.99)' --rate "
                             "100 --replicates 2 --sets 8 --seed 3 "
                             "--samples " +
                             std::to_string(samples) + " " + more);
    ASSERT_EQ(made.status, 0) << made.errors;
  }
  void shell(const std::string& script) const {
    EXPECT_EQ(std::system(("cd '" + folder_.string() + "' && " + script).c_str()), 0) << script;
  }
};

TEST_F(BatchCommands, SimulationsAreTheSameHoweverTheyAreCutAndRun) {
  make("one", "--shard-size 8");
  make("many", "--shard-size 3");
  const Outcome one = run("batch run one --workers 1 --json");
  ASSERT_EQ(one.status, 0) << one.errors;
  const Outcome many = run("batch run many --workers 3 --report page.html");
  ASSERT_EQ(many.status, 0) << many.errors;
  EXPECT_EQ(read("one/merged.json"), read("many/merged.json"));
  EXPECT_EQ(json::parse(one.out), json::parse(read("one/merged.json")));
  EXPECT_NE(many.out.find("8 sets of 2 replicates"), std::string::npos) << many.out;
  EXPECT_NE(read("page.html").find("phi"), std::string::npos);
  const json parameters = json::parse(one.out)["simulation"]["parameters"];
  ASSERT_EQ(parameters.size(), 3U);
  EXPECT_EQ(parameters[2]["truth"], 0.99);
}

TEST_F(BatchCommands, AKilledWorkersShardIsRunAgain) {
  constexpr int kLong = 400'000;  // a shard lasts half a second
  make("batch", "--shard-size 4", kLong);
  // The first worker that is seen is killed in the middle of its work.
  shell("{ '" IMUNOISE_BINARY
        "' batch run batch --workers 1 > run.txt 2>&1 & run=$!; while sleep 0.01; do child=$(cat "
        "/proc/$run/task/$run/children); test -z \"$child\" || break; done; sleep 0.05; "
        "kill -9 $child; wait $run; }");
  EXPECT_EQ(read("batch/log/000000.txt"), "imunoise: killed by signal 9\n");
  const json status = json::parse(run("batch status batch --json").out);
  EXPECT_EQ(status["done"], 2);
  make("whole", "--shard-size 8", kLong);
  EXPECT_EQ(run("batch run whole").status, 0);
  EXPECT_EQ(read("batch/merged.json"), read("whole/merged.json"));
}

TEST_F(BatchCommands, ADamagedResultIsMadeAgain) {
  make("batch", "--shard-size 4");
  EXPECT_EQ(run("batch shard batch 0").status, 0);
  const std::string good = read("batch/results/000000.json");
  shell("truncate -s 100 batch/results/000000.json");
  const Outcome status = run("batch status batch");
  EXPECT_NE(status.out.find("0 of 2 shards are complete"), std::string::npos) << status.out;
  EXPECT_NE(status.out.find("damaged"), std::string::npos) << status.out;
  const Outcome merge = run("batch merge batch");
  EXPECT_EQ(merge.status, 1);
  EXPECT_NE(merge.errors.find("imunoise batch run"), std::string::npos) << merge.errors;
  EXPECT_EQ(run("batch run batch").status, 0);
  EXPECT_EQ(read("batch/results/000000.json"), good);
}

TEST_F(BatchCommands, CalibratesRecordings) {
  for (const std::string name : {"monday", "tuesday"}) {
    testing::SimulatedRecording what;
    what.folder = folder_ / name;
    what.channels = {{"gyro_x", "rad/s", "WN(sigma2=1e-6)"}};
    what.samples = 1024;
    testing::record(what);
  }
  ASSERT_EQ(run("batch new batch --calibrate monday tuesday --model WN --no-diagnose").status, 0);
  // One recording is away for now.
  shell("mv tuesday away");
  const Outcome failed = run("batch run batch --retries 1");
  EXPECT_EQ(failed.status, 1);
  EXPECT_NE(failed.out.find("1 of 2 shards are complete"), std::string::npos) << failed.out;
  EXPECT_NE(failed.out.find("tuesday"), std::string::npos) << failed.out;
  EXPECT_FALSE(std::filesystem::exists(folder_ / "monday/calibration.json"));
  shell("mv away tuesday");
  const Outcome run_again = run("batch run batch");
  ASSERT_EQ(run_again.status, 0) << run_again.errors;
  for (const std::string name : {"monday", "tuesday"}) {
    const json kept = json::parse(read(name + "/calibration.json"));
    EXPECT_EQ(kept["channels"][0]["fit"]["model"], "WN") << name;
  }
  EXPECT_EQ(run("calibrations .").status, 0);
}

TEST_F(BatchCommands, RefusesWhatIsNoBatch) {
  EXPECT_EQ(run("batch new b").status, 2);
  EXPECT_EQ(run("batch new b --simulate 'WN(sigma2=1)' --rate 1 --sets 3").status, 2);
  EXPECT_EQ(run("batch new b --simulate WN --rate 1 --samples 64 --sets 3").status, 1);
  std::filesystem::create_directory(folder_ / "empty");
  EXPECT_EQ(run("batch run empty").status, 1);
  make("batch");
  EXPECT_EQ(run("batch run batch --sbatch=--partition=x").status, 2);
  EXPECT_EQ(run("batch shard batch 99").status, 1);
}

}  // namespace
}  // namespace imunoise
