// `imunoise dynamic` as a user runs it.

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

// A gyro on a table that turns at 30, 90, 150 and 210 °/s, with ramps between: table.csv; its white
// noise grows from 0.1 to 0.3 °/s. The same dwells in a file each: 30.csv .. 210.csv.
class Dynamic : public testing::Program {
 protected:
  void SetUp() override {
    std::mt19937_64 random(20261121);
    std::normal_distribution<double> normal;
    std::ofstream table(folder_ / "table.csv");
    table << "gyro,rate [deg/s]\n";
    for (int level = 0; level < 4; ++level) {
      const double rate = 30.0 + 60.0 * level;
      const double sigma = 0.1 * std::pow(3.0, level / 3.0);
      for (int k = 0; k < 25 && level > 0; ++k) {
        const double passing = rate - 60.0 + 2.4 * k + 1.2;
        table << passing << ',' << passing << '\n';
      }
      std::ofstream dwell(folder_ / (std::to_string(static_cast<int>(rate)) + ".csv"));
      dwell << "gyro,rate [deg/s]\n";
      for (int k = 0; k < 4000; ++k) {
        const double x = rate + sigma * normal(random);
        table << x << ',' << rate << '\n';
        dwell << x << ',' << rate << '\n';
      }
    }
  }
};

TEST_F(Dynamic, FollowsTheNoiseOverTheRate) {
  const Outcome done =
      run("dynamic table.csv --rate 100 --unit deg/s --covariate rate --covariate-unit deg/s "
          "--model 'WN + RW' --json --report out.html");
  ASSERT_EQ(done.status, 0) << done.errors;
  const json report = json::parse(done.out);
  EXPECT_EQ(report["channel"], "gyro");
  EXPECT_EQ(report["covariate"], "rate");
  EXPECT_EQ(report["covariate_unit"], "deg/s");
  EXPECT_EQ(report["model"], "WN(sigma2~exp) + RW(gamma2~exp)");
  EXPECT_TRUE(report["plateaus"].get<bool>());
  ASSERT_EQ(report["bins"].size(), 4U);
  EXPECT_EQ(report["bins"][0]["samples"], 4000);
  EXPECT_EQ(report["left_out"], 75);
  const json& trend = report["trends"][0];
  EXPECT_TRUE(trend["test"]["rejected"].get<bool>());
  EXPECT_NEAR(trend["slope"].get<double>() * 180.0 / (2.0 * std::log(3.0)), 1.0, 0.05);
  EXPECT_FALSE(report["trends"][1]["test"]["rejected"].get<bool>());
  const json& walk = report["quantities"][0];
  EXPECT_EQ(walk["unit"], "°/√h");
  ASSERT_EQ(walk["separate"].size(), 4U);
  EXPECT_EQ(walk["curve"].size(), 41U);
  EXPECT_NEAR(walk["bins"][0]["value"].get<double>(), 0.1 / std::sqrt(100.0) * 60.0, 0.02);
  EXPECT_NEAR(walk["bins"][3]["value"].get<double>(), 0.3 / std::sqrt(100.0) * 60.0, 0.06);
  EXPECT_NE(read("out.html").find("N of WN: angle random walk"), std::string::npos);

  // The same dwells in files of their own, and bins where the user says.
  const Outcome files =
      run("dynamic 30.csv 90.csv 150.csv 210.csv --rate 100 --unit deg/s --covariate rate "
          "--model 'WN + RW' --json");
  ASSERT_EQ(files.status, 0) << files.errors;
  EXPECT_EQ(json::parse(files.out)["trends"], report["trends"]);
  const Outcome chosen = run(
      "dynamic table.csv --rate 100 --covariate rate --bins 30,210 --settle 1 --model 'WN' --json");
  ASSERT_EQ(chosen.status, 0) << chosen.errors;
  EXPECT_EQ(json::parse(chosen.out)["bins"].size(), 2U);
  EXPECT_EQ(json::parse(chosen.out)["bins"][1]["samples"], 3900);
}

TEST_F(Dynamic, AnswersPeople) {
  const Outcome done =
      run("dynamic table.csv --rate 100 --unit deg/s --covariate rate --model 'WN(sigma2~linear)'");
  ASSERT_EQ(done.status, 0) << done.errors;
  EXPECT_NE(done.out.find("gyro over rate"), std::string::npos) << done.out;
  EXPECT_NE(done.out.find("1 recording · 4 bins"), std::string::npos) << done.out;
  EXPECT_NE(done.out.find("N of WN grows from"), std::string::npos) << done.out;
  EXPECT_NE(done.out.find("75 of 16075 samples were discarded"), std::string::npos) << done.out;
  const Outcome again =
      run("--threads 1 dynamic table.csv --rate 100 --unit deg/s --covariate rate --model "
          "'WN(sigma2~linear)'");
  EXPECT_EQ(again.out, done.out);
}

TEST_F(Dynamic, SaysWhatItCannotDo) {
  const auto expect = [&](const std::string& arguments, const std::string& words) {
    const Outcome done = run("dynamic " + arguments);
    EXPECT_NE(done.status, 0) << arguments;
    EXPECT_NE(done.errors.find(words), std::string::npos) << arguments << ": " << done.errors;
  };
  std::ofstream stuck(folder_ / "stuck.csv");
  stuck << "gyro,rate\n";
  for (int i = 0; i < 64; ++i) stuck << (i < 32 ? 5 : i * i % 7) << ',' << i / 32 << '\n';
  stuck.close();
  expect("table.csv --rate 100", "--covariate is required");
  expect("table.csv --rate 100 --covariate temperature", "no channel 'temperature'");
  expect("30.csv --rate 100 --covariate rate", "only one is a place where it stays");
  expect("table.csv --rate 100 --covariate rate --bins 1", "2 to 1000 bins");
  expect("table.csv --rate 100 --covariate rate --bins 30,", "2 to 1000 bins");
  expect("table.csv --rate 100 --covariate rate --bins 30,fast", "bin centres such as");
  expect("table.csv --rate 100 --covariate rate --bins 500,600", "nowhere is a place");
  expect("table.csv --rate 100 --covariate rate --model 'AR1(phi~exp)'", "phi follows a covariate");
  expect("table.csv --rate 100 --covariate rate --model 'WN(sigma2=1)'", "fixes every power");
  expect("table.csv --rate 100 --covariate rate --model '5*AR1 + 4*RES'", "free parameters");
  expect("stuck.csv --rate 1 --covariate rate --model WN", "never changes where rate is about 0");
  const Outcome single = run("fit table.csv --rate 100 --channel gyro --model 'WN(sigma2~)'");
  EXPECT_NE(single.errors.find("only in imunoise dynamic"), std::string::npos) << single.errors;
}

}  // namespace
}  // namespace imunoise
