// Files of other programs, as a user gives them to the program; and progress on a terminal.

#include <fmt/format.h>
#include <gtest/gtest.h>
#include <poll.h>
#include <pty.h>

#include <chrono>
#include <nlohmann/json.hpp>
#include <random>
#include <set>

#include "tests/cli/program.h"

namespace imunoise {
namespace {

using nlohmann::json;
using testing::Outcome;

class PlainFiles : public testing::Program {
 protected:
  // Rates (deg/s) at 100 Hz; accelerations (m/s²) in every `each`th row.
  void write_imu(const std::string& name, int rows, int each = 1) const {
    std::mt19937 random(4);
    std::normal_distribution<double> normal;
    std::ofstream file(folder_ / name);
    file << "t,wx [deg/s],wy [deg/s],wz [deg/s],ax [m/s^2],ay [m/s^2],az [m/s^2]\n";
    for (int i = 0; i < rows; ++i) {
      file << fmt::format("{:.2f}", 0.01 * i);
      for (int a = 0; a < 3; ++a) file << fmt::format(",{:.6f}", 0.05 * normal(random));
      for (int a = 0; a < 3; ++a) {
        const double value = 0.02 * normal(random) + (a == 2 ? 9.81 : 0.0);
        file << (i % each == 0 ? fmt::format(",{:.6f}", value) : ",");
      }
      file << "\n";
    }
  }
  void put(const std::string& name, const std::string& text) const {
    std::ofstream(folder_ / name) << text;
  }
  json json_of(const std::string& arguments) const {
    const Outcome done = run(arguments + " --json");
    EXPECT_EQ(done.status, 0) << arguments << "\n" << done.errors;
    return json::parse(done.out);
  }
};

TEST_F(PlainFiles, SaysOnceWhatHoldsForManyFiles) {
  for (const char* const name : {"a.csv", "b.csv", "c.csv"}) write_imu(name, 4000);
  const Outcome done = run("wv a.csv b.csv c.csv --channel wx");
  ASSERT_EQ(done.status, 0) << done.errors;
  EXPECT_NE(done.errors.find("a.csv and 2 more files: time:"), std::string::npos) << done.errors;
  EXPECT_EQ(done.errors.find("b.csv"), std::string::npos) << done.errors;
}

TEST_F(PlainFiles, EveryJsonHasThePreflight) {
  write_imu("a.csv", 4000);
  for (const std::string command :
       {"wv a.csv", "wv a.csv --allan", "fit a.csv --model WN",
        "test a.csv --split-into 2 --model WN",
        "select a.csv --split-into 4 --model WN --model 'WN + RW'", "diagnose a.csv --model WN"}) {
    const json got = json_of(command + " --channel wx");
    ASSERT_EQ(got["preflight"].size(), 1U) << command;
    EXPECT_EQ(got["preflight"][0]["file"], "a.csv") << command;
    EXPECT_EQ(got["preflight"][0]["samples"], "4000") << command;
  }
  EXPECT_EQ(json_of("array a.csv --channel wx,wy --model WN")["preflight"].size(), 1U);
  const Outcome page = run("wv a.csv --channel wx --allan --report a.html");
  ASSERT_EQ(page.status, 0) << page.errors;
  EXPECT_NE(read("a.html").find("no faults found"), std::string::npos);
}

// A sensor that states no unit never goes missing without a word.
TEST_F(PlainFiles, AxesWithoutAUnitAreNamed) {
  write_imu("a.csv", 4000);
  const std::string whole = read("a.csv");
  put("silent.csv", "t,wx,wy,wz,ax [m/s^2],ay [m/s^2],az [m/s^2]" + whole.substr(whole.find('\n')));
  const Outcome exported = run("export silent.csv --to kalibr --model WN");
  EXPECT_EQ(exported.status, 1);
  EXPECT_NE(exported.errors.find("wx, wy, wz: no unit is stated"), std::string::npos)
      << exported.errors;
  EXPECT_EQ(run("export silent.csv --to kalibr --model WN --channel 'acc_*'").status, 0);
  const json calibrated = json_of("calibrate silent.csv --model WN --no-diagnose");
  ASSERT_EQ(calibrated["channels"].size(), 6U);
  EXPECT_EQ(calibrated["channels"][0]["troubles"][0]["step"], "unit");
  const Outcome diagnosed = run("diagnose silent.csv --model WN --json");
  ASSERT_EQ(diagnosed.status, 0) << diagnosed.errors;
  EXPECT_EQ(json::parse(diagnosed.out)["channels"].size(), 3U);
  EXPECT_NE(diagnosed.errors.find("wx, wy, wz: not diagnosed"), std::string::npos)
      << diagnosed.errors;
  EXPECT_EQ(json_of("diagnose a.csv --model WN")["channels"].size(), 6U);
}

TEST_F(PlainFiles, WhatCannotBeIsRefusedInPlainWords) {
  write_imu("a.csv", 4000);
  put("esc.csv", "t,\x1b[31mred\n0,1\n0.01,2\n");
  put("fit.json", run("fit a.csv --channel wx --model WN --json").out);
  const std::pair<const char*, const char*> cases[] = {
      {"wv a.csv --unit 'rate_*=deg/s'", "no channel has this name"},
      {"wv a.csv --from 30 --until 10", "--from 30 is not before --until 10"},
      {"wv a.csv --channel wq", "did you mean"},
      {"export a.csv fit.json --to kalibr", "export one kind at a time"},
      {"export fit.json fit.json --to csv", "wx is there twice"},
      {"fit fit.json", "is JSON, no recording"},
      {"fit a.csv --svg noise.png", "it writes no png"},
      {"fit a.csv --confidence 95", "--confidence: 95 is not between 0.5 and 0.9999\n"},
      {"open --port 99999", "--port: 99999 is not between 1 and 65535\n"},
      {"datasheet a.csv --gyro N=0.3", "'N=0.3' has no unit"},
      {"export a.csv --to kf", "choose one of kf-gins, kf-json"},
      {"wv esc.csv --channel y", "\xef\xbf\xbd[31mred"}};
  for (const auto& [command, words] : cases) {
    const Outcome done = run(command);
    EXPECT_NE(done.status, 0) << command;
    EXPECT_NE(done.errors.find(words), std::string::npos) << command << ": " << done.errors;
    EXPECT_EQ(done.errors.find('\x1b'), std::string::npos) << command;
  }
}

// Nothing was calibrated: a script must see that.
TEST_F(PlainFiles, ACalibrationWithoutAModelIsAFailure) {
  std::string text = "t,wx [rad/s]\n";
  for (int i = 0; i < 2000; ++i) text += std::to_string(0.01 * i) + ",0.125\n";
  put("constant.csv", text);
  const Outcome done = run("calibrate constant.csv --no-diagnose");
  EXPECT_EQ(done.status, 1);
  EXPECT_NE(done.out.find("0 of 1 channels have a model"), std::string::npos) << done.out;
}

// A RealSense has two sensors of two rates.
TEST_F(PlainFiles, SensorsOfTwoRatesAreCalibratedAlike) {
  write_imu("a.csv", 8000, 4);
  const json got = json_of("calibrate a.csv --model WN --no-diagnose");
  ASSERT_EQ(got["channels"].size(), 6U);
  EXPECT_EQ(got["channels"][0]["fit"]["rate_hz"], 100.0);
  EXPECT_EQ(got["channels"][5]["channel"], "az");
  EXPECT_EQ(got["channels"][5]["fit"]["rate_hz"], 25.0);
  const Outcome text = run("calibrate a.csv --model WN --no-diagnose");
  // 0.05°/s at 100 Hz; 0.02 m/s² at 25 Hz.
  for (const char* const part : {"Noise of all channels", "minimum / 0.664", "°/√h", "rad/s/√Hz",
                                 "µg/√Hz", "m/s^2/√Hz", "Bias instability"})
    EXPECT_NE(text.out.find(part), std::string::npos) << part << "\n" << text.out;
  const Outcome kalibr = run("export a.csv --model WN --to kalibr");
  ASSERT_EQ(kalibr.status, 0) << kalibr.errors;
  EXPECT_NE(kalibr.out.find("\ngyroscope_noise_density:"), std::string::npos) << kalibr.out;
  EXPECT_NE(kalibr.out.find("\naccelerometer_noise_density:"), std::string::npos) << kalibr.out;
}

TEST_F(PlainFiles, ExportJoinsTheFitsOfTwoFiles) {
  write_imu("a.csv", 4000);
  const auto fit = [&](const std::string& channels, const std::string& to) {
    std::ofstream(folder_ / to) << run("fit a.csv --model WN --json --channel " + channels).out;
  };
  fit("wx,wy,wz", "gyro.json");
  fit("ax,ay,az", "acc.json");
  const Outcome kalibr = run("export gyro.json acc.json --to kalibr");
  ASSERT_EQ(kalibr.status, 0) << kalibr.errors;
  EXPECT_NE(kalibr.out.find("\ngyroscope_noise_density:"), std::string::npos) << kalibr.out;
  EXPECT_NE(kalibr.out.find("\naccelerometer_noise_density:"), std::string::npos) << kalibr.out;
}

TEST_F(PlainFiles, AMistypedProgramIsGuessed) {
  write_imu("a.csv", 100);
  const Outcome got = run("export a.csv --to kalibrr");
  EXPECT_EQ(got.status, 2);
  EXPECT_NE(got.errors.find("did you mean 'kalibr'?"), std::string::npos) << got.errors;
}

TEST_F(PlainFiles, AnotherCommonNameChoosesTheSameChannel) {
  write_imu("imu.csv", 8000);
  for (const char* const command :
       {"fit imu.csv --model WN", "test imu.csv --model WN --split-into 2",
        "select imu.csv --model WN --model 'WN + RW'", "diagnose imu.csv --model WN"}) {
    const json got = json_of(fmt::format("{} --channel gyr_x", command));
    EXPECT_EQ(got["channel"], "wx") << command;
  }
  const Outcome exported = run("export imu.csv --channel gyr_x --model WN --to csv");
  EXPECT_EQ(exported.status, 0) << exported.errors;
}

TEST_F(PlainFiles, ExportRefusesWhatHasNoEffectOnAResult) {
  write_imu("imu.csv", 4000);
  ASSERT_EQ(run("fit imu.csv --channel wx --model WN --json > fit.json").status, 0);
  EXPECT_EQ(run("export fit.json --to csv").status, 0);
  for (const char* const option : {"--model WN", "--rate 200", "--unit 'wx=rad/s'", "--from 1"}) {
    const Outcome got = run(fmt::format("export fit.json --to csv {}", option));
    EXPECT_EQ(got.status, 1) << option;
    EXPECT_NE(got.errors.find("is a result of imunoise"), std::string::npos) << got.errors;
  }
  const Outcome twice = run("export imu.csv imu.csv --model WN --to csv");
  EXPECT_EQ(twice.status, 1);
  EXPECT_EQ(twice.errors.find("known: )"), std::string::npos) << twice.errors;
}

// Runs the program with standard error on a terminal; returns what it wrote there.
std::string on_terminal(const std::filesystem::path& folder, std::vector<std::string> arguments,
                        int& status) {
  int terminal = -1;
  const pid_t child = forkpty(&terminal, nullptr, nullptr, nullptr);
  if (child == 0) {
    std::vector<char*> all;
    arguments.insert(arguments.begin(), IMUNOISE_BINARY);
    for (std::string& one : arguments) all.push_back(one.data());
    all.push_back(nullptr);
    if (chdir(folder.c_str()) == 0) execv(IMUNOISE_BINARY, all.data());
    _exit(127);
  }
  std::string out;
  std::array<char, 4096> buffer{};
  for (ssize_t n = 0; (n = ::read(terminal, buffer.data(), buffer.size())) > 0;)
    out.append(buffer.data(), static_cast<std::size_t>(n));
  int ended = 0;
  waitpid(child, &ended, 0);
  close(terminal);
  status = WEXITSTATUS(ended);
  return out;
}

TEST_F(PlainFiles, ProgressMovesOnATerminal) {
  int status = -1;
  std::string shown;
  std::chrono::duration<double> took{};
  // Work of less than two seconds tells nothing: as much as this machine needs three for.
  for (std::size_t samples = 80'000; took.count() < 3.0; samples *= 2) {
    ASSERT_EQ(run("simulate --model 'WN(sigma2=1e-6) + AR1(sigma2=1e-8, phi=0.99) + "
                  "RW(gamma2=1e-12)' --rate 100 --samples " +
                  std::to_string(samples) + " --unit rad/s --seed 2 --channel gyro_x --out long.h5")
                  .status,
              0);
    const auto begin = std::chrono::steady_clock::now();
    shown = on_terminal(folder_, {"diagnose", "long.h5", "--model", "WN + RW", "--auto", "--json"},
                        status);
    took = std::chrono::steady_clock::now() - begin;
    ASSERT_EQ(status, 0) << shown;
  }
  std::set<std::string> lines;
  const std::string erased = "\r\033[K";
  std::size_t last = std::string::npos;
  for (std::size_t at = shown.find(erased); at != std::string::npos;) {
    const std::size_t next = shown.find(erased, at + erased.size());
    const std::string line = shown.substr(at + erased.size(), next - at - erased.size());
    // Between lines of progress stands what was recognised; a slow machine also shows the reading.
    const bool progress = line.find('\n') == std::string::npos && !line.starts_with("reading ");
    if (next != std::string::npos && progress) lines.insert(line);
    last = at;
    at = next;
  }
  EXPECT_GE(lines.size(), 3U) << shown.substr(0, 2000);
  for (const std::string& line : lines) EXPECT_NE(line.find("gyro_x "), std::string::npos) << line;
  // The line goes before the result comes.
  ASSERT_NE(last, std::string::npos);
  EXPECT_EQ(shown[last + erased.size()], '{') << shown.substr(last, 200);
}

}  // namespace
}  // namespace imunoise
