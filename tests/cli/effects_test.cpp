// One grammar: every command that takes a model takes its effects, and its help lists them.

#include <gtest/gtest.h>

#include <nlohmann/json.hpp>

#include "core/effects/known_effects.h"
#include "tests/cli/program.h"

namespace imunoise::testing {
namespace {

constexpr const char* kModel = "WN + RW + line(f=5)";
constexpr double kAmplitude = 0.5;

using nlohmann::json;

class EffectsOfAModel : public Program {
 protected:
  EffectsOfAModel() {
    const Outcome done = run(
        "simulate --model 'WN(sigma2=1) + RW(gamma2=1e-4) + line(f=5, amplitude=0.5)' --rate 100 "
        "--samples 4096 --replicates 3 --seed 8 --unit rad/s --channel gyro_x --out s.h5");
    EXPECT_EQ(done.status, 0) << done.errors;
  }

  json report_of(const std::string& command) {
    const Outcome done = run(command + " s_?.h5 --channel gyro_x --model '" + kModel + "' --json");
    EXPECT_EQ(done.status, 0) << command << ": " << done.errors;
    return json::parse(done.out);
  }
};

// The amplitude that an operation took out covers the one that was simulated.
void expect_line(const json& effects, const std::string& command) {
  ASSERT_EQ(effects.size(), 1U) << command;
  EXPECT_EQ(effects[0]["term"], "line(f=5)") << command;
  bool told = false;
  for (const json& one : effects[0]["parameters"]) {
    if (one["name"] != "amplitude") continue;
    told = true;
    // An interval of 95 %, and one more half-width on either side.
    const double lower = one["lower"];
    const double upper = one["upper"];
    EXPECT_NEAR(0.5 * (lower + upper), kAmplitude, upper - lower) << command;
    EXPECT_EQ(one["unit"], "rad/s") << command;
  }
  EXPECT_TRUE(told) << command;
}

TEST_F(EffectsOfAModel, AreFittedAndTakenOutByEveryCommand) {
  for (const std::string command : {"fit", "test", "select"}) {
    const json report = report_of(command);
    expect_line(report["effects"], command);
  }
  EXPECT_EQ(report_of("fit")["model"], kModel);
  EXPECT_EQ(report_of("select")["chosen"], kModel);
  const json diagnosis = report_of("diagnose");
  expect_line(diagnosis["ladder"][0]["effects"], "diagnose");
  EXPECT_EQ(
      run(std::string("study new a.study s_?.h5 --channel gyro_x --model '") + kModel + "'").status,
      0);
  const json study = json::parse(run("study show a.study --json").out);
  expect_line(study["attempts"][0]["rung"]["effects"], "study");
}

TEST_F(EffectsOfAModel, AreAllInTheHelpOfDiagnose) {
  const std::string help = run("diagnose --help").out;
  for (const Effect* effect : known_effects()) {
    EXPECT_NE(help.find("\n  " + std::string(effect->name)), std::string::npos) << effect->name;
    EXPECT_NE(help.find(effect->meaning.substr(0, 20)), std::string::npos) << effect->name;
  }
}

}  // namespace
}  // namespace imunoise::testing
