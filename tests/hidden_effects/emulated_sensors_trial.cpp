// Effects inside the physics of an emulated ADIS16405, seen through its real driver, the recorder
// and chunk files: rounded to the sensor's codes, filtered and timed as it does. Scored apart from
// the trial on generated numbers, because here the detector's own house made the noise.

#include <gtest/gtest.h>

#include <algorithm>
#include <cstdio>
#include <nlohmann/json.hpp>
#include <vector>

#include "tests/cli/program.h"
#include "tests/hidden_effects/scoring/statistics.h"

namespace imunoise::hidden {
namespace {

using nlohmann::json;

constexpr int kReplicates = 3;
constexpr int kSeconds = 1200;  // of each replicate, at 102.4 Hz
constexpr int kSeeds = 3;

struct Hidden {
  const char* name;
  const char* text;                // as `imunoise emulate --help` has it; empty: nothing
  std::vector<std::string> right;  // what it may be called
};

const std::vector<Hidden>& hidden() {
  static const std::vector<Hidden> all{
      {"nothing", "", {}},
      {"fan", "fan(frequency=13.7,amplitude=2e-4,harmonics=1,channel=gyro_x)", {"line"}},
      {"fan with harmonics",
       "fan(frequency=9.3,amplitude=3e-4,harmonics=4,channel=gyro_x)",
       {"line", "harmonics"}},
      {"mains", "mains(amplitude=2e-4,channel=gyro_x)", {"mains_alias", "line"}},
      {"step", "step(at=500,height=1e-3,channel=gyro_x)", {"step"}},
      {"telegraph", "telegraph(height=2e-3,dwell=100,channel=gyro_x)", {"telegraph"}},
      {"outliers", "outliers(share=1e-4,deviation=0.03,channel=gyro_x)", {"outliers"}},
      {"warm-up", "warm_up(size=2e-3,time=100,channel=gyro_x)", {"warm_up"}},
      {"temperature",
       "temperature(swing=2,period=400,coupling=5e-4,lag=20,channel=gyro_x)",
       {"temperature"}},
  };
  return all;
}

class EmulatedSensorsTrial : public imunoise::testing::Program {
 protected:
  // What the tool says of three replicates with something inside.
  json diagnosis_of(const std::string& effect, int seed) const {
    const std::string inside = effect.empty() ? "" : " 'effect=" + effect + "'";
    for (int k = 1; k <= kReplicates; ++k) {
      const auto recorded =
          run("record sealed --replicate " + std::to_string(k) +
              " --device \"emulated device=adis16405 speed=0 length=" + std::to_string(kSeconds) +
              " seed=" + std::to_string(100 * seed + k) +
              " 'model=gyro: WN(sigma2=9e-6) + RW(gamma2=1e-11)'" + inside + "\"");
      EXPECT_EQ(recorded.status, 0) << recorded.errors;
    }
    const auto told = run("diagnose sealed --channel emulated/imu/gyro_x --model 'WN + RW' --json");
    EXPECT_EQ(told.status, 0) << told.errors;
    std::filesystem::remove_all(folder_ / "sealed");
    return json::parse(told.out);
  }
};

std::string first_of(const json& report) {
  return report["candidates"].empty() ? "" : report["candidates"][0]["effect"].get<std::string>();
}

TEST_F(EmulatedSensorsTrial, EveryEffectThatTheyCanHide) {
  std::printf("seeds 1 to %d, %d replicates of %d s\n", kSeeds, kReplicates, kSeconds);
  Share alarms;
  Share named;
  Share wrong;
  for (const Hidden& one : hidden()) {
    std::string said;
    for (int seed = 1; seed <= kSeeds; ++seed) {
      const json report = diagnosis_of(one.text, seed);
      const auto verdict = report["verdict"].get<std::string>();
      const std::string first = first_of(report);
      said += (seed > 1 ? ", " : "") + verdict + (verdict == "none" ? "" : " " + first);
      if (one.right.empty()) {
        alarms.add(verdict != "none");
        continue;
      }
      const bool right = verdict != "none" &&
                         std::find(one.right.begin(), one.right.end(), first) != one.right.end();
      named.add(right);
      wrong.add(verdict == "found" && !right);
    }
    std::printf("%-20s %s\n", one.name, said.c_str());
    std::fflush(stdout);
  }
  std::printf("named first: %s; confidently wrong: %s; false alarms: %s\n",
              to_string(named).c_str(), to_string(wrong).c_str(), to_string(alarms).c_str());
  EXPECT_GE(named.upper(), 0.90);
  EXPECT_LE(wrong.lower(), 0.03);
  EXPECT_LE(alarms.lower(), 0.05);
}

}  // namespace
}  // namespace imunoise::hidden
