// `imunoise diagnose` and `imunoise study` as a user runs them.

#include <fmt/format.h>
#include <gtest/gtest.h>

#include <filesystem>
#include <fstream>
#include <nlohmann/json.hpp>
#include <random>

#include "tests/cli/program.h"

namespace imunoise {
namespace {

using nlohmann::json;
using testing::Outcome;

// Three replicates of a gyro with quantisation noise that WN + RW lacks: gyro_1.h5 .. gyro_3.h5.
class Diagnose : public testing::Program {
 protected:
  void SetUp() override {
    const Outcome made =
        run("simulate --model 'WN(sigma2=1e-6) + RW(gamma2=1e-11) + QN(q2=3e-7)' --rate 50 "
            "--samples 4096 --replicates 3 --seed 3 --unit rad/s --channel gyro_x --out gyro.h5");
    ASSERT_EQ(made.status, 0) << made.errors;
  }
  static constexpr const char* kFiles = "gyro_1.h5 gyro_2.h5 gyro_3.h5";
};

TEST_F(Diagnose, NamesWhatIsMissingAndTheErrorFalls) {
  const Outcome done =
      run(std::string("diagnose ") + kFiles +
          " --channel gyro_x --model 'WN + RW' --auto --json --report out.html --svg out.svg");
  ASSERT_EQ(done.status, 0) << done.errors;
  EXPECT_TRUE(std::filesystem::exists(folder_ / "out.html"));
  EXPECT_NE(read("out_before.svg").find("WN + RW"), std::string::npos);
  EXPECT_NE(read("out_after.svg").find("WN + RW + QN"), std::string::npos);
  EXPECT_NE(read("out_spectrum_before.svg").find("frequency, Hz"), std::string::npos);
  EXPECT_NE(read("out_spectrum_after.svg").find("WN + RW + QN"), std::string::npos);
  EXPECT_NE(read("out_errors.svg").find("averaging times"), std::string::npos);
  const json report = json::parse(done.out);
  EXPECT_EQ(report.at("verdict"), "found");
  const json& best = report.at("candidates").at(0);
  EXPECT_EQ(best.at("effect"), "quantisation");
  EXPECT_EQ(best.at("term"), "QN");
  EXPECT_LT(best.at("familywise_p"), 1e-6);
  EXPECT_LT(best.at("unexplained_after"), best.at("unexplained_before"));
  for (const char* field : {"gain_nats", "parameters", "confused_with", "record_next", "sentence"})
    EXPECT_TRUE(best.contains(field)) << field;
  ASSERT_GE(report.at("ladder").size(), 2U);
  EXPECT_EQ(report.at("ladder").at(1).at("added"), "QN");
  EXPECT_EQ(report.at("ladder").at(1).at("unexplained"), 1.0);
  EXPECT_GT(report.at("ladder").at(0).at("unexplained"), 1.5);
  for (const json& view : report.at("ladder").at(1).at("views")) {
    for (const char* field : {"view", "value", "floor", "chance_limit", "unit", "p", "sentence"})
      EXPECT_TRUE(view.contains(field)) << field;
  }
  EXPECT_GT(report.at("ladder").at(1).at("misfit_p"), 1e-3);
}

TEST_F(Diagnose, SaysWhatIsWrong) {
  const std::string files = kFiles;
  EXPECT_NE(run("diagnose " + files + " --channel gyro_y").errors.find("gyro_y"),
            std::string::npos);
  EXPECT_NE(run("diagnose " + files + " --witness heat").errors.find("no such channel"),
            std::string::npos);
  EXPECT_NE(run("diagnose " + files + " --model 'WN + line'").errors.find("needs f="),
            std::string::npos);
}

TEST_F(Diagnose, AStudyIsKeptInItsFile) {
  const std::string files = kFiles;
  EXPECT_EQ(run("study new a.study " + files + " --channel gyro_x --model 'WN + RW'").status, 0);
  EXPECT_EQ(run("study new a.study " + files).status, 1);  // there is one already
  EXPECT_EQ(run("study add a.study QN").status, 0);
  const Outcome shown = run("study show a.study --json");
  ASSERT_EQ(shown.status, 0) << shown.errors;
  const json study = json::parse(shown.out);
  EXPECT_EQ(study.at("attempts").size(), 2U);
  EXPECT_EQ(study.at("attempts").at(1).at("rung").at("model"), "WN + RW + QN");
  EXPECT_EQ(run("study undo a.study").status, 0);
  EXPECT_EQ(run("study undo a.study").status, 1);
  EXPECT_EQ(run("study report a.study page.html").status, 0);
  EXPECT_TRUE(std::filesystem::exists(folder_ / "page.html"));
}

TEST_F(Diagnose, WhatIsReadIsNotOverwritten) {
  const std::string files = kFiles;
  const std::string first = files.substr(0, files.find(' '));
  const std::string before = read(first);
  const Outcome done = run("diagnose " + files + " --model WN --report ./" + first);
  EXPECT_NE(done.status, 0);
  EXPECT_NE(done.errors.find("is one of the recordings"), std::string::npos) << done.errors;
  EXPECT_EQ(read(first), before);
  ASSERT_EQ(run("study new a.study " + files + " --channel gyro_x --model WN").status, 0);
  EXPECT_NE(run("study report a.study a.study").status, 0);
  EXPECT_EQ(run("study show a.study").status, 0);
}

TEST_F(Diagnose, AStudyTakesWhateverFitTakes) {
  std::string text = "time,wx,ax,ay,az\n";
  std::mt19937 random(4);
  std::normal_distribution<double> noise;
  for (int i = 0; i < 2000; ++i) {
    text += fmt::format("{},{:.4f},{:.4f},{:.4f},{:.4f}\n", 5 * i + (i < 1000 ? 0 : 400),
                        0.1 * noise(random), 0.02 * noise(random), 0.02 * noise(random),
                        1.0 + 0.02 * noise(random));
  }
  std::ofstream(folder_ / "odd.csv") << text;
  const std::string how =
      " odd.csv --unit 'gyro_*=deg/s,acc_*=g' --time-unit ms --from 0.5 --exclude 1..1.1 "
      "--channel gyro_x --model WN";
  const Outcome made = run("study new odd.study" + how);
  ASSERT_EQ(made.status, 0) << made.errors;
  const json study = json::parse(run("study show odd.study --json").out);
  EXPECT_EQ(study.at("unit"), "rad/s");
  EXPECT_EQ(study.at("rate_hz"), 200.0);
  ASSERT_EQ(study.at("preflight").size(), 1U);
  EXPECT_EQ(study.at("preflight").at(0).at("stretches"), 3);
  EXPECT_EQ(study.at("preflight").at(0).at("used"), "1880");
  const json& found = study.at("preflight").at(0).at("findings").at(0);
  EXPECT_EQ(found.at("left_out"), true);
  EXPECT_NE(found.at("text").get<std::string>().find("gap of 0.4 s"), std::string::npos) << found;
  EXPECT_EQ(run("study add odd.study QN").status, 0) << "reads the file in the same way again";
  EXPECT_EQ(run("study report odd.study odd.html").status, 0);
  EXPECT_NE(read("odd.html").find("gap of 0.4 s"), std::string::npos);
  const Outcome fitted = run("fit" + how + " --json --report fit.html");
  ASSERT_EQ(fitted.status, 0) << fitted.errors;
  EXPECT_EQ(json::parse(fitted.out).at("preflight").at(0).at("findings").at(0), found);
  EXPECT_NE(read("fit.html").find("gap of 0.4 s"), std::string::npos);
  const Outcome refused = run("study new strict.study --strict" + how);
  EXPECT_EQ(refused.status, 1);
  EXPECT_NE(refused.errors.find("--strict refuses"), std::string::npos) << refused.errors;
}

TEST_F(Diagnose, AStudyWhoseRecordingIsGoneSaysSo) {
  const std::string files = kFiles;
  const std::string first = files.substr(0, files.find(' '));
  ASSERT_EQ(run("study new a.study " + files + " --channel gyro_x --model WN").status, 0);
  std::filesystem::rename(folder_ / first, folder_ / "elsewhere");
  const Outcome done = run("study add a.study RW");
  EXPECT_EQ(done.status, 1);
  EXPECT_NE(done.errors.find("not found; this study needs it"), std::string::npos) << done.errors;
}

}  // namespace
}  // namespace imunoise
