// `imunoise mixed` as a user runs it.

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

// sites.csv: two series that share a slow noise; temperature moves both by 2 a unit, `nothing`
// neither.
class Mixed : public testing::Program {
 protected:
  void SetUp() override {
    std::mt19937_64 random(20261122);
    std::normal_distribution<double> normal;
    std::ofstream file(folder_ / "sites.csv");
    file.precision(12);
    file << "a,b,temperature,nothing,stuck,fahrenheit\n";
    double shared = 0.0;
    double nothing = 0.0;
    for (int i = 0; i < 600; ++i) {
      shared = 0.95 * shared + 0.3 * normal(random);
      nothing = 0.97 * nothing + 0.3 * normal(random);
      const double temperature = std::sin(0.05 * i) + 0.1 * normal(random);
      file << 5.0 + 2.0 * temperature + shared + normal(random) << ','
           << -5.0 + 2.0 * temperature + shared + normal(random) << ',' << temperature << ','
           << nothing << ",1," << 32.0 + 1.8 * temperature << "\n";
    }
  }
};

TEST_F(Mixed, TellsAnEffectFromSharedNoise) {
  const Outcome done =
      run("mixed sites.csv --rate 1 --channel a,b --model 'AR1[all] + WN' --regress temperature "
          "--regress nothing --bootstrap 99 --json --report out.html");
  ASSERT_EQ(done.status, 0) << done.errors;
  const json report = json::parse(done.out);
  EXPECT_EQ(report["series"], json({"a", "b"}));
  EXPECT_EQ(report["samples"], "600");
  ASSERT_EQ(report["coefficients"].size(), 2U);
  const json& effect = report["coefficients"][0];
  EXPECT_EQ(effect["regressor"], "temperature");
  EXPECT_TRUE(effect["significant"]);
  const double error = effect["gls"]["standard_error"];
  EXPECT_NEAR(effect["gls"]["value"].get<double>(), 2.0, 4.0 * error);
  EXPECT_NEAR(effect["gls"]["p_value"].get<double>(), 0.01, 1e-9);
  EXPECT_TRUE(effect.contains("robust"));
  EXPECT_LT(effect["naive"]["standard_error"].get<double>(), error);
  // Ten between the constants; the shared noise does not touch the difference.
  EXPECT_NEAR(
      report["constants"][0]["value"].get<double>() - report["constants"][1]["value"].get<double>(),
      10.0, 0.3);
  double sum = 0.0;
  for (const json& term : report["explained"][0]["terms"]) sum += term["share"].get<double>();
  EXPECT_NEAR(sum, 1.0, 1e-9);
  std::ifstream page(folder_ / "out.html");
  EXPECT_TRUE(page.good());
}

TEST_F(Mixed, ARegressorOfItsOwnForEachSeries) {
  const Outcome done =
      run("mixed sites.csv --rate 1 --channel a,b --model 'AR1[all] + WN' --regress "
          "x=temperature,nothing --regress time --bootstrap 0");
  ASSERT_EQ(done.status, 0) << done.errors;
  for (const char* word : {"x", "time", "GLS under the noise", "AR1[all]", "bootstrap"})
    EXPECT_NE(done.out.find(word), std::string::npos) << word << "\n" << done.out;
}

TEST_F(Mixed, SaysWhatItCannotDo) {
  const auto expect = [&](const std::string& arguments, const char* words) {
    const Outcome done = run("mixed sites.csv --rate 1 " + arguments);
    EXPECT_NE(done.status, 0) << arguments;
    EXPECT_NE(done.errors.find(words), std::string::npos) << arguments << "\n" << done.errors;
  };
  expect("", "--regress");
  expect("--channel a,b --regress humidity", "humidity");
  expect("--channel a,b --regress stuck", "never changes");
  expect("--channel a,b,stuck --regress temperature", "never changes");
  expect("--channel a,b --regress x=temperature,nothing,temperature", "3 channels for 2 series");
  expect("--channel a,b --regress time --regress time", "named twice");
  expect("--channel a,b --regress time --bootstrap 18", "cannot reject at 5 %");
  expect("--channel a,b --regress temperature --regress fahrenheit", "cannot be told apart");
  expect("--channel a --regress a", "none is left");
  expect("--channel a,b --regress time --model 'DR + WN'", "DR is not noise");
  expect("--channel a,b --regress time --group a,c", "no sensor 'c'");
  expect("--channel a,b --regress time --robust 0.6", "--robust");
}

}  // namespace
}  // namespace imunoise
