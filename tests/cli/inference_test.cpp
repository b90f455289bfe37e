// `imunoise test` and `imunoise select` as a user runs them.

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <fstream>
#include <nlohmann/json.hpp>
#include <sstream>

#include "tests/cli/program.h"

namespace imunoise {
namespace {

using nlohmann::json;
using testing::Outcome;

bool contains(const std::string& text, const std::string& part) {
  return text.find(part) != std::string::npos;
}

// Four replicates of AR1 + WN, s_1.h5 .. s_4.h5, and two more with a third more white noise.
class Inference : public testing::Program {
 protected:
  void SetUp() override {
    simulate("AR1(sigma2=0.05, phi=0.98) + WN(sigma2=1)", "--replicates 4 --seed 3 --out s.h5");
    simulate("AR1(sigma2=0.05, phi=0.98) + WN(sigma2=1.3)",
             "--replicates 2 --seed 4 --out loud.h5");
  }

  void simulate(const std::string& model, const std::string& more) const {
    const Outcome done =
        run("simulate --model '" + model + "' --rate 100 --samples 8192 --unit rad/s " + more);
    ASSERT_EQ(done.status, 0) << done.errors;
  }

  json json_of(const std::string& arguments) const {
    const Outcome done = run(arguments + " --json");
    EXPECT_EQ(done.status, 0) << done.errors;
    return json::parse(done.out);
  }
};

TEST_F(Inference, TwoReplicatesDoNotTellWhichParameterDiffers) {
  const json two = json_of("test s_1.h5 loud_1.h5 --model 'AR1 + WN'");
  EXPECT_NE(two["summary"].get<std::string>().find("takes three replicates"), std::string::npos)
      << two["summary"];
}

TEST_F(Inference, TestTellsTheFourAnswersApart) {
  const std::string stable = "test s_?.h5 --model ";
  const std::string moved = "test s_?.h5 loud_?.h5 --model ";
  Outcome done = run(stable + "'AR1 + WN'");
  ASSERT_EQ(done.status, 0) << done.errors;
  EXPECT_TRUE(contains(done.out, "x: near-stationary\n")) << done.out;
  EXPECT_TRUE(contains(done.out, "4 replicates hardly show")) << done.out;
  EXPECT_TRUE(contains(run(stable + "'WN + RW'").out, "x: misfit\n"));
  done = run(moved + "'AR1 + WN'");
  EXPECT_TRUE(contains(done.out, "x: parameters differ\n")) << done.out;
  EXPECT_TRUE(contains(done.out, "Different: sigma2 of WN by")) << done.out;
  EXPECT_TRUE(contains(run(moved + "'WN + RW'").out, "x: misfit, and parameters differ\n"));
}

TEST_F(Inference, TestAsJson) {
  const json plain = json_of("test s_?.h5 loud_?.h5 --model 'AR1 + WN'");
  EXPECT_EQ(plain["model"], "AR1 + WN");
  EXPECT_EQ(plain["replicates"], 6);
  EXPECT_EQ(plain["unit"], "rad/s");
  EXPECT_FALSE(plain["misfit"]["rejected"]);
  EXPECT_TRUE(plain["heterogeneity"]["rejected"]);
  EXPECT_EQ(plain["heterogeneity"]["degrees_of_freedom"], 5 * 3);
  EXPECT_FALSE(plain["misfit"].contains("bootstrap_p_value"));
  EXPECT_FALSE(plain.contains("published_p_value"));
  EXPECT_GT(plain["published_statistic"], 0.0);
  ASSERT_EQ(plain["spread"].size(), 3U);
  for (const json& one : plain["spread"]) {
    EXPECT_EQ(one["moves"], one["term"] == "WN") << one;
    EXPECT_LE(one["lower"], one["spread"]);
    EXPECT_LE(one["spread"], one["upper"]);
  }
  // Four times ln 1, twice ln 1.3: their standard deviation is 0.136; estimation adds 2 % each.
  EXPECT_NEAR(plain["spread"][2]["relative"].get<double>(), 0.136, 0.04);
}

TEST_F(Inference, BootstrapDependsOnTheSeedAlone) {
  const std::string command = "test s_?.h5 --model 'AR1 + WN' --bootstrap 39";
  const json first = json_of(command);
  EXPECT_EQ(first["bootstrap_sets"], 39);
  EXPECT_EQ(first["seed"], "1");
  for (const json& p : {first["misfit"]["bootstrap_p_value"],
                        first["heterogeneity"]["bootstrap_p_value"], first["published_p_value"]}) {
    // A multiple of 1/40, and at least one.
    const double fortieths = 40.0 * p.get<double>();
    EXPECT_NEAR(fortieths, std::round(fortieths), 1e-9);
    EXPECT_GE(fortieths, 1.0);
  }
  EXPECT_EQ(json_of(command), first);
  EXPECT_EQ(json_of(command + " --threads 1"), first);
  const json other = json_of(command + " --seed 2");
  EXPECT_EQ(other["seed"], "2");
  EXPECT_NE(other["heterogeneity"]["bootstrap_p_value"],
            first["heterogeneity"]["bootstrap_p_value"]);
  EXPECT_EQ(other["heterogeneity"]["p_value"], first["heterogeneity"]["p_value"]);
}

// 19 sets can reject at 5 %, and reject a model as wrong as this.
TEST_F(Inference, SmallestBootstrapRejects) {
  const json report = json_of("test s_?.h5 --model WN --bootstrap 19");
  EXPECT_EQ(report["misfit"]["bootstrap_p_value"], 0.05);
  EXPECT_TRUE(report["misfit"]["rejected"]);
  const Outcome fewer = run("test s_?.h5 --model WN --bootstrap 18");
  EXPECT_EQ(fewer.status, 1);
  EXPECT_TRUE(contains(fewer.errors, "at least 19")) << fewer.errors;
}

// A question that cannot be asked has no answer.
TEST_F(Inference, TestWithoutFreeParametersSaysWhatItDidNotTest) {
  const std::string command = "test s_?.h5 --model 'AR1(sigma2=0.05, phi=0.98) + WN(sigma2=1)'";
  const json report = json_of(command + " --bootstrap 19");
  EXPECT_EQ(report["heterogeneity"]["degrees_of_freedom"], 0);
  EXPECT_FALSE(report["heterogeneity"].contains("p_value"));
  EXPECT_FALSE(report["heterogeneity"].contains("bootstrap_p_value"));
  EXPECT_FALSE(report["misfit"]["rejected"]);
  EXPECT_FALSE(contains(report["summary"], "Near-stationary")) << report["summary"];
  const std::string text = run(command).out;
  EXPECT_TRUE(contains(text, "do parameters differ?  not tested")) << text;
}

TEST_F(Inference, SelectComparesAllSubModels) {
  const Outcome done = run("select s_?.h5 --model 'AR1 + WN + RW'");
  ASSERT_EQ(done.status, 0) << done.errors;
  EXPECT_TRUE(contains(done.out, "AR1 + WN has the smallest held-out error")) << done.out;
  EXPECT_TRUE(contains(done.out, "4 splits (leave one out)")) << done.out;
  EXPECT_TRUE(contains(done.out, "4 replicates hardly show")) << done.out;
  std::istringstream lines(done.out);
  for (std::string line; std::getline(lines, line);) {
    EXPECT_EQ(std::count(line.begin(), line.end(), '('), std::count(line.begin(), line.end(), ')'))
        << "a number is cut: " << line;
  }
  const json report = json_of("select s_?.h5 --model 'AR1 + WN + RW'");
  ASSERT_EQ(report["candidates"].size(), 7U);
  EXPECT_EQ(report["splits"], "leave one out");
  EXPECT_EQ(report["split_count"], 4);
  EXPECT_EQ(report["weights"], "full");
  EXPECT_FALSE(report["far_from_floor"]);
  EXPECT_EQ(report["candidates"][0]["model"], "AR1 + WN");
  EXPECT_EQ(report["candidates"][0]["parameters"], 3);
  EXPECT_EQ(report["chosen"], "AR1 + WN");
  double before = 0.0;
  for (const json& one : report["candidates"]) {
    const bool first = one == report["candidates"][0];
    const bool enough = contains(one["model"], "AR1 + WN");
    EXPECT_EQ(one["verdict"], first    ? "selected"
                              : enough ? "equivalent"
                                       : "not_appropriate")
        << one;
    EXPECT_GE(one["merit"], before - 1e-6);  // those that are the same come by size
    EXPECT_NEAR(one["merit"].get<double>() - report["candidates"][0]["merit"].get<double>(),
                one["excess"].get<double>(), 2e-6 * one["merit"].get<double>());
    before = one["merit"];
  }
}

TEST_F(Inference, SelectComparesJustTheModelsNamed) {
  const json report =
      json_of("select s_?.h5 --model 'WN + RW' --model WN --splits half --weights diag");
  ASSERT_EQ(report["candidates"].size(), 2U);
  EXPECT_EQ(report["candidates"][0]["model"], "WN + RW");
  EXPECT_EQ(report["splits"], "half");
  EXPECT_EQ(report["split_count"], 6);  // 2 of 4
  EXPECT_EQ(report["weights"], "diag");
}

TEST_F(Inference, SelectSaysWhenEveryModelLacksSomething) {
  const json report = json_of("select s_?.h5 --model 'WN + RW'");
  EXPECT_TRUE(report["far_from_floor"]);
  EXPECT_TRUE(contains(report["summary"], "far from the floor")) << report["summary"];
}

TEST_F(Inference, SelectCutsASingleRecordingAndSaysSo) {
  const json report = json_of("select s_1.h5 --model 'AR1 + WN'");
  EXPECT_TRUE(report["contiguous_blocks"]);
  EXPECT_EQ(report["replicates"], 6);
  EXPECT_TRUE(contains(report["notes"].dump(), "contiguous blocks"));
  EXPECT_FALSE(json_of("select s_1.h5 s_2.h5 --model WN")["contiguous_blocks"]);
}

TEST_F(Inference, SelectIsTheSameEveryTimeAndForAnyNumberOfThreads) {
  const std::string command = "select s_?.h5 --model 'AR1 + WN + RW' --splits half --json";
  const std::string first = run(command).out;
  EXPECT_EQ(run(command).out, first);
  EXPECT_EQ(run(command + " --threads 1").out, first);
}

TEST_F(Inference, BothSayWhenTheyChooseTheModelThemselves) {
  for (const char* command : {"test s_?.h5", "select s_?.h5"}) {
    const json report = json_of(command);
    EXPECT_TRUE(contains(report["notes"].dump(), "No model was named: 2*AR1 + WN + RW")) << command;
  }
  // The sub-models, and what the search for FN, QN and DR adds.
  EXPECT_GT(json_of("select s_?.h5")["candidates"].size(), 11U);
}

TEST_F(Inference, BothWriteOnePageForAllChannels) {
  for (const int k : {1, 2, 3}) {
    std::ofstream file(folder_ / ("two_" + std::to_string(k) + ".csv"));
    file << "gyro_x [rad/s],<b>&\n";
    for (int t = 0; t < 2048; ++t) {
      file << (t * 7919 + k * 31) % 1009 * k << "," << (t * 104729 + k * 57) % 2003 * k << "\n";
    }
  }
  for (const std::string command : {"test", "select"}) {
    const Outcome done =
        run(command + " two_?.csv --rate 100 --model 'WN + RW' --json --report page.html");
    ASSERT_EQ(done.status, 0) << done.errors;
    EXPECT_TRUE(contains(done.errors, "wrote page.html")) << done.errors;
    const json reports = json::parse(done.out);
    ASSERT_EQ(reports["channels"].size(), 2U);
    EXPECT_EQ(reports["channels"][1]["channel"], "<b>&");
    const std::string page = read("page.html");
    EXPECT_TRUE(contains(page, "<svg")) << command;
    EXPECT_TRUE(contains(page, "&lt;b&gt;&amp;")) << command;
    EXPECT_FALSE(contains(page, "<b>")) << command;
    EXPECT_EQ(page.find("http"), page.find("http://www.w3.org"));  // nothing from the network
  }
}

TEST_F(Inference, RefuseWithTheWayOut) {
  const auto refused = [&](const std::string& arguments, int status, const std::string& words) {
    const Outcome done = run(arguments);
    EXPECT_EQ(done.status, status) << arguments;
    EXPECT_EQ(done.out, "") << arguments;
    EXPECT_TRUE(contains(done.errors, words)) << arguments << "\n" << done.errors;
  };
  refused("test s_1.h5", 1, "--split-into 6");
  refused("test s_1.h5 s_2.h5 s_1.h5", 1, "have the same samples");
  simulate("WN(sigma2=0)", "--replicates 2 --out still.h5");
  for (const std::string name : {"same_1.csv", "same_2.csv"}) {
    std::ofstream file(folder_ / name);  // the mean of many 3.2 is not 3.2
    file << "gyro_x [rad/s]\n";
    for (int t = 0; t < 5000; ++t) file << "3.2\n";
  }
  for (const std::string command : {"test", "select"}) {
    refused(command + " still_?.h5 --model WN", 1, "still_1: x never changes");
    refused(command + " same_?.csv --rate 1 --model WN", 1, "same_1: gyro_x never changes");
    refused(command + " s_?.h5 --model 'WN + ?'", 1, "  WN + ?\n       ^");
    refused(command + " s_?.h5 --model ''", 1, "expected the name of a process");
    refused(command + " s_?.h5 --model '8*AR1'", 1, "16 free parameters");
    refused(command + " s_?.h5 --model WN --report no/page.html", 1, "no/page.html: cannot");
    refused(command + " s_?.h5 --model WN --confidence 0.9", 2, "--confidence");
    refused(command + " missing.h5", 2, "missing.h5");
  }
  refused("select s_?.h5 --model 'WN + RW' --model 'RW + WN'", 1, "are the same");
  refused("select s_?.h5 --splits thirds", 2, "--splits");
  ASSERT_EQ(run("simulate --model 'WN(sigma2=1)' --rate 1 --samples 6000 --unit 1 --out short.csv")
                .status,
            0);
  refused("select short.csv --rate 1 --split-into 21 --splits half", 1, "leave-one-out");
  refused("select short.csv --model WN", 1, "too short to be cut");
}

}  // namespace
}  // namespace imunoise
