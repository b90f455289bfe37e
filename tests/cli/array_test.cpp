// `imunoise array` as a user runs it.

#include <gtest/gtest.h>

#include <cmath>
#include <fstream>
#include <nlohmann/json.hpp>
#include <random>

#include "tests/cli/program.h"

namespace imunoise {
namespace {

using nlohmann::json;
using testing::Outcome;

// Two replicates of three gyros, a.csv and b.csv: white noise of their own, and a random walk that
// the first two share to 80 %.
class Array : public testing::Program {
 protected:
  void SetUp() override {
    std::mt19937_64 random(20261121);
    std::normal_distribution<double> normal;
    for (const char* name : {"a.csv", "b.csv"}) {
      std::ofstream file(folder_ / name);
      file << "gyro_a,gyro_b,gyro_c\n";
      double x = 0.0;
      double y = 0.0;
      double z = 0.0;
      for (int i = 0; i < 20'000; ++i) {
        const double step = normal(random);
        x += 1e-3 * step;
        y += 1e-3 * (0.8 * step + 0.6 * normal(random));
        z += 1e-3 * normal(random);
        file << x + 0.02 * normal(random) << ',' << y + 0.04 * normal(random) << ','
             << z + 0.03 * normal(random) << '\n';
      }
    }
  }
};

TEST_F(Array, FindsWhatIsSharedAndWeighsTheSensors) {
  const Outcome done = run(
      "array a.csv b.csv --rate 100 --unit rad/s --model 'RW[corr] + WN' --optimise short --json "
      "--report out.html");
  ASSERT_EQ(done.status, 0) << done.errors;
  const json report = json::parse(done.out);
  EXPECT_EQ(report["model"], "RW[corr] + WN");
  EXPECT_EQ(report["sensors"], json({"gyro_a", "gyro_b", "gyro_c"}));
  EXPECT_EQ(report["unit"], "rad/s");
  ASSERT_EQ(report["parameters"].size(), 9U);
  const json& shared = report["parameters"][1];  // of gyro_a and gyro_b
  EXPECT_EQ(shared["sensors"], json({"gyro_a", "gyro_b"}));
  EXPECT_GT(shared["correlation_lower"].get<double>(), 0.5);
  EXPECT_LT(shared["correlation_lower"].get<double>(), 0.8);
  EXPECT_GT(shared["correlation_upper"].get<double>(), 0.8);
  ASSERT_EQ(report["pairs"].size(), 3U);
  EXPECT_TRUE(report["pairs"][0]["dependent"].get<bool>());
  EXPECT_FALSE(report["pairs"][1]["dependent"].get<bool>());
  EXPECT_FALSE(report["pairs"][2]["dependent"].get<bool>());
  const json& budget = report["budgets"][2]["terms"];
  EXPECT_EQ(budget[0]["term"], "RW[corr]");
  EXPECT_NEAR(budget[0]["share"].get<double>() + budget[1]["share"].get<double>(), 1.0, 1e-12);
  // At short averaging times white noise is all: weights go with the inverse of its power.
  const json& weights = report["virtual_sensor"]["weights"];
  const double sum = 1 / 4.0 + 1 / 16.0 + 1 / 9.0;
  EXPECT_NEAR(weights[0]["weight"].get<double>(), 1 / 4.0 / sum, 0.02);
  EXPECT_NEAR(weights[1]["weight"].get<double>(), 1 / 16.0 / sum, 0.02);
  EXPECT_NEAR(weights[2]["weight"].get<double>(), 1 / 9.0 / sum, 0.02);
  const json& gain = report["virtual_sensor"]["scale_gains"][0];
  EXPECT_NEAR(gain["predicted"].get<double>(), 1 / sum / (29.0 / 9.0), 0.02);
  EXPECT_NEAR(gain["measured"].get<double>(), gain["predicted"].get<double>(), 0.05);
  EXPECT_NE(read("out.html").find("Gain of the virtual sensor"), std::string::npos);
}

TEST_F(Array, AnswersPeople) {
  const Outcome done =
      run("array a.csv b.csv --rate 100 --unit rad/s --model 'RW[corr] + WN' --rule non-negative");
  ASSERT_EQ(done.status, 0) << done.errors;
  EXPECT_NE(done.out.find("gyro_a, gyro_b  yes"), std::string::npos) << done.out;
  EXPECT_NE(done.out.find("Virtual sensor (non-negative, for all averaging times)"),
            std::string::npos);
  const Outcome again =
      run("--threads 1 array a.csv b.csv --rate 100 --unit rad/s --model 'RW[corr] + WN' --rule "
          "non-negative");
  EXPECT_EQ(again.out, done.out);
}

TEST_F(Array, OfSoFewSamplesNothingIsKnownToBeShared) {
  std::ofstream file(folder_ / "short.csv");
  file << "p,q\n";
  for (int i = 0; i < 17; ++i) file << i * i % 7 << ',' << i * i % 5 << '\n';
  file.close();
  const Outcome done = run("array short.csv --rate 1 --model WN --json");
  ASSERT_EQ(done.status, 0) << done.errors;
  EXPECT_FALSE(json::parse(done.out)["pairs"][0]["dependent"].get<bool>());
}

TEST_F(Array, SaysWhatItCannotDo) {
  const auto expect = [&](const std::string& arguments, const std::string& words) {
    const Outcome done = run("array a.csv --rate 100 " + arguments);
    EXPECT_NE(done.status, 0) << arguments;
    EXPECT_NE(done.errors.find(words), std::string::npos) << arguments << ": " << done.errors;
  };
  std::ofstream stuck_file(folder_ / "stuck.csv");
  std::ofstream mixed_file(folder_ / "mixed.csv");
  stuck_file << "p,q,r\n";
  mixed_file << "gyro (rad/s),acc (m/s^2)\n";
  for (int i = 0; i < 32; ++i) {
    stuck_file << i * i % 7 << ",2," << i * i % 5 << '\n';
    mixed_file << i * i % 7 << ',' << i * i % 5 << '\n';
  }
  stuck_file.close();
  mixed_file.close();
  const Outcome stuck = run("array stuck.csv --rate 1");
  EXPECT_NE(stuck.errors.find("q never changes"), std::string::npos) << stuck.errors;
  expect("--model '5*AR1 + 4*RES'", "free parameters per sensor");
  expect("--model 'DR + WN' --estimator whittle", "takes no ramp");
  expect("--channel gyro_a", "at least two sensors");
  expect("--model 'RW[cor]'", "corr, group or all");
  expect("--model ''", "expected the name of a process");
  expect("--group gyro_a,nobody", "no sensor 'nobody'");
  expect("--group gyro_a,gyro_b", "no process that the sensors of a group share");
  expect("--group gyro_a,gyro_b --group gyro_b,gyro_c", "'gyro_b' is in two groups");
  expect("--optimise 1,2", "13 weights");
  expect("--optimise sometimes", "13 weights");
  expect("--robust 0.6", "--robust");
  const Outcome mixed = run("array mixed.csv --rate 100");
  EXPECT_NE(mixed.status, 0);
  EXPECT_NE(mixed.errors.find("measure the same thing"), std::string::npos) << mixed.errors;
  const Outcome single = run("fit a.csv --rate 100 --model 'RW[corr] + WN'");
  EXPECT_NE(single.errors.find("only among the sensors of an array"), std::string::npos);
}

}  // namespace
}  // namespace imunoise
