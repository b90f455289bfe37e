// `imunoise faults` as a user runs it.

#include <gtest/gtest.h>

#include <array>
#include <cmath>
#include <fstream>
#include <nlohmann/json.hpp>
#include <random>

#include "tests/cli/program.h"

namespace imunoise {
namespace {

using nlohmann::json;
using testing::Outcome;

constexpr int kSamples = 20'000;
constexpr int kOnset = 12'000;

// Three gyros about one axis that share a random walk, read to four decimals, at 100 Hz: good.csv,
// and others with what happens to them.
class Faults : public testing::Program {
 protected:
  void SetUp() override {
    write("good.csv", [](int, auto&) {});
    write("step.csv", [](int t, auto& x) { x[1] += t >= kOnset ? 0.02 : 0.0; });
    write("many.csv", [this](int t, auto& x) {
      if (t >= 8000) x[2] += 0.03 * normal_(random_);
      if (t == kOnset) held_ = x[0];
      if (t >= kOnset) x[0] = held_;
    });
  }

  template <class Change>
  void write(const char* name, const Change& change) {
    std::ofstream file(folder_ / name);
    file << "gyro_a,gyro_b,gyro_c\n";
    file.setf(std::ios::fixed);
    file.precision(4);
    double walk = 0.0;
    for (int t = 0; t < kSamples; ++t) {
      walk += 1e-4 * normal_(random_);
      std::array<double, 3> x = {walk + 0.01 * normal_(random_), walk + 0.012 * normal_(random_),
                                 walk + 0.015 * normal_(random_)};
      change(t, x);
      file << x[0] << ',' << x[1] << ',' << x[2] << '\n';
    }
  }

  std::mt19937_64 random_{20261121};
  std::normal_distribution<double> normal_;
  double held_ = 0.0;
  std::array<double, 3> all_{};
};

const std::string kHow = " --rate 100 --unit rad/s --model 'RW[all] + WN' ";

TEST_F(Faults, NamesTheSensorTheTimeAndTheSize) {
  const Outcome done =
      run("faults step.csv many.csv --train good.csv" + kHow + "--json --report out.html");
  ASSERT_EQ(done.status, 0) << done.errors;
  const json report = json::parse(done.out);
  EXPECT_TRUE(report["trained_elsewhere"].get<bool>());
  ASSERT_EQ(report["faults"].size(), 3U) << report.dump(1);
  const json& step = report["faults"][0];
  EXPECT_EQ(step["kind"], "step");
  EXPECT_EQ(step["sensors"], json({"gyro_b"}));
  EXPECT_EQ(step["replicate"], "step");
  EXPECT_NEAR(step["size"].get<double>(), 0.02, 4.0 * step["size_error"].get<double>());
  EXPECT_NEAR(step["onset_s"].get<double>(), 120.0, 0.2);
  EXPECT_LT(step["delay_s"].get<double>(), 1.0);
  const json& noisy = report["faults"][1];
  EXPECT_EQ(noisy["kind"], "noisy");
  EXPECT_EQ(noisy["sensors"], json({"gyro_c"}));
  EXPECT_FALSE(noisy.contains("size_error"));
  const json& stuck = report["faults"][2];
  EXPECT_EQ(stuck["kind"], "stuck");
  EXPECT_EQ(stuck["sensors"], json({"gyro_a"}));
  EXPECT_NEAR(stuck["onset_s"].get<double>(), 120.0, 0.03);
  EXPECT_NEAR(report["stuck_rules"][0]["resolution"].get<double>(), 1e-4, 1e-9);
  EXPECT_EQ(report["traces"].size(), 6U);
  EXPECT_NE(read("out.html").find("each sensor against the mean of the others"), std::string::npos);
}

TEST_F(Faults, AnswersPeople) {
  const Outcome sound = run("faults good.csv" + kHow);
  ASSERT_EQ(sound.status, 0) << sound.errors;
  EXPECT_NE(sound.out.find("No sensor steps, sticks or grows noisy"), std::string::npos);
  EXPECT_NE(sound.out.find("--train"), std::string::npos) << "the model knows these recordings";
  const Outcome two = run("faults step.csv --train good.csv --channel gyro_a,gyro_b" + kHow);
  EXPECT_NE(two.out.find("gyro_a or gyro_b  step"), std::string::npos) << two.out;
  EXPECT_NE(two.out.find("a third would tell"), std::string::npos);
}

// What the import takes for a disturbance is a fault here.
TEST_F(Faults, SearchesWhatAFitLeavesOut) {
  write("both.csv", [](int t, auto& x) {
    x[0] += t >= kOnset ? 0.2 : 0.0;
    x[1] -= t >= kOnset ? 0.1 : 0.0;
  });
  write("frozen.csv", [this](int t, auto& x) {
    if (t == kOnset) all_ = x;
    if (t >= kOnset) x = all_;
  });
  const json both = json::parse(run("faults both.csv --train good.csv" + kHow + "--json").out);
  ASSERT_GE(both["faults"].size(), 1U) << both.dump(1);
  EXPECT_EQ(both["faults"][0]["kind"], "step");
  EXPECT_NEAR(both["faults"][0]["onset_s"].get<double>(), 120.0, 0.2);
  const json frozen = json::parse(run("faults frozen.csv --train good.csv" + kHow + "--json").out);
  ASSERT_GE(frozen["faults"].size(), 1U) << frozen.dump(1);
  EXPECT_EQ(frozen["faults"][0]["kind"], "stuck");
  EXPECT_NEAR(frozen["faults"][0]["onset_s"].get<double>(), 120.0, 0.03);
}

TEST_F(Faults, WhatIsSearchedIsNotTrainedOn) {
  const json report =
      json::parse(run("faults step.csv --train good.csv --train step.csv" + kHow + "--json").out);
  EXPECT_EQ(report["trained_on"], 1);
  EXPECT_TRUE(report["trained_elsewhere"].get<bool>());
  const json itself = json::parse(run("faults step.csv --train step.csv" + kHow + "--json").out);
  EXPECT_FALSE(itself.value("trained_elsewhere", false));
}

TEST_F(Faults, SaysWhatItCannotDo) {
  const auto expect = [&](const std::string& arguments, const std::string& words) {
    const Outcome done = run("faults " + arguments);
    EXPECT_NE(done.status, 0) << arguments;
    EXPECT_NE(done.errors.find(words), std::string::npos) << arguments << ": " << done.errors;
  };
  std::ofstream other_file(folder_ / "other.csv");
  other_file << "gyro_a,gyro_b\n";
  for (int i = 0; i < 64; ++i) other_file << i * i % 7 << ',' << i * i % 5 << '\n';
  other_file.close();
  expect("good.csv --rate 100 --channel gyro_a", "at least two sensors");
  expect("good.csv --rate 100 --model 'RW[all]'", "independent noise");
  expect("good.csv --rate 100 --train nobody.csv", "no such file");
  expect("good.csv --rate 100 --train other.csv", "other channels");
  expect("good.csv --rate 100 --false-alarms-per-hour 0", "--false-alarms-per-hour");
  expect("good.csv --rate 100 --robust 0.6", "--robust");
}

}  // namespace
}  // namespace imunoise
