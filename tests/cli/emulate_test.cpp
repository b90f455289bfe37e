// `imunoise emulate` and the driver `emulated` as a user without hardware runs them.

#include <gtest/gtest.h>

#include <nlohmann/json.hpp>

#include "tests/cli/program.h"

namespace imunoise {
namespace {

using nlohmann::json;
using testing::Outcome;

class Emulate : public testing::Program {
 protected:
  // The report of a recording that must succeed.
  json report(const Outcome& done) const {
    EXPECT_EQ(done.status, 0) << done.errors;
    return json::parse(done.out);
  }
  // Records with one program what another serves, for a second.
  json record_served(const std::string& serving, const std::string& device) const {
    // The first command takes the folder; what follows ';' runs there.
    return report(
        run("--version > version.txt; " IMUNOISE_BINARY " emulate " + serving +
            " > said.txt & server=$!; for i in $(seq 400); do grep -q Ctrl-C said.txt && break; "
            "sleep 0.05; done; " IMUNOISE_BINARY " record monday --device '" +
            device + "' --duration 1 --json; kill $server; wait $server"));
  }
  static long stored(const json& report, const std::string& stream) {
    for (const json& one : report["streams"]) {
      if (one["stream"] == stream) return std::stol(one["stored"].get<std::string>());
    }
    return -1;
  }
};

TEST_F(Emulate, ServesAnMtiToARecorderOfItsOwn) {
  const json done = record_served("--device xsens --at mti --seed 3", "xsens port=pty:mti");
  EXPECT_GE(stored(done, "imu"), 50);
  EXPECT_NE(read("said.txt").find("xsens port=pty:mti"), std::string::npos);
  EXPECT_NE(read("said.txt").find("messages"), std::string::npos) << "it ends in good order";
}

TEST_F(Emulate, ServesACanImuToARecorderOfItsOwn) {
  const json done =
      record_served("--device can --at unix:imu.can", "can interface=unix:imu.can preset=mti600");
  EXPECT_GE(stored(done, "RateOfTurn"), 50);
}

TEST_F(Emulate, ReplicatesHaveNumbersOfTheirOwn) {
  report(
      run("record monday --device 'emulated device=adis16405 speed=0 seed=2' --duration 1 "
          "--replicates 2 --json"));
  const Outcome fit = run("fit monday --channel emulated/imu/gyro_x --model WN");
  EXPECT_EQ(fit.status, 0) << fit.errors;
}

// The length is counted in the time of the device, so that a fast and a slow machine record alike.
TEST_F(Emulate, TheSameSeedAndLengthAreTheSameSamples) {
  const std::string device =
      " --device 'emulated device=adis16405 speed=0 length=20 seed=4' --json";
  const long first = stored(report(run("record monday" + device)), "imu");
  EXPECT_NEAR(static_cast<double>(first), 20.0 * 102.4, 2.0);
  EXPECT_EQ(stored(report(run("record tuesday" + device)), "imu"), first);
  const std::string wv = " --channel emulated/imu/gyro_x --json";
  EXPECT_EQ(json::parse(run("wv monday" + wv).out)["variance"],
            json::parse(run("wv tuesday" + wv).out)["variance"]);
}

TEST_F(Emulate, RecordsAnAdis16405WhoseEffectsAreThere) {
  report(
      run("record monday --device \"emulated device=adis16405 speed=0 seed=2 "
          "model=gyro:WN(sigma2=1e-6) 'effect=fan(frequency=20, amplitude=0.1)'\" --duration 2 "
          "--json"));
  const json wv = json::parse(run("wv monday --channel emulated/imu/gyro_x --json").out);
  // A line of amplitude 0.1 rad/s has more variance at the first scales than all the noise.
  EXPECT_GT(wv["variance"][0].get<double>(), 1e-4);
}

TEST_F(Emulate, EndsByItself) {
  const Outcome done = run("emulate --device can --at unix:imu.can --duration 0.3");
  EXPECT_EQ(done.status, 0) << done.errors;
  EXPECT_NE(done.out.find("seed 1"), std::string::npos) << done.out;
}

TEST_F(Emulate, SaysWhatItCannotDo) {
  const auto expect = [&](const std::string& arguments, const std::string& words) {
    const Outcome done = run("emulate " + arguments);
    EXPECT_NE(done.status, 0) << arguments;
    EXPECT_NE(done.errors.find(words), std::string::npos) << arguments << ": " << done.errors;
  };
  expect("", "--device");
  expect("--device sextant", "sextant");
  expect("--device adis16405", "emulated device=adis16405");
  expect("--device xsens --at mti --model 'gyro: WN'", "leaves values open");
  expect("--device xsens --at mti --effect 'wind()'", "no effect 'wind'");
  expect("--device can --at unix:x --fault 'stall(sample=1)'", "count is missing");
  expect("--device can --at unix:x --preset sextant", "sextant");
  expect("--device can --at nocan7", "nocan7");
  expect("--device xsens --at absent/folder/mti", "absent/folder/mti");
}

}  // namespace
}  // namespace imunoise
