#include <algorithm>
#include <cstdlib>

#include "tests/cli/program.h"

namespace imunoise::testing {
namespace {

class ExportCommand : public Program {
 protected:
  void simulate() {
    ASSERT_EQ(
        run("simulate --model 'WN(sigma2=1e-6) + RW(gamma2=1e-10)' --rate 100 --samples 20000 "
            "--seed 7 --unit rad/s --channel gyro_x --out g.h5")
            .status,
        0);
  }
};

double value_of(const std::string& text, const std::string& key) {
  const std::size_t at = text.find("\n" + key + ": ");
  return at == std::string::npos ? 0.0 : std::atof(text.c_str() + at + key.size() + 3);
}

TEST_F(ExportCommand, FromRecordingsAndFromTheirFitGiveTheSameValues) {
  simulate();
  const Outcome direct = run("export g.h5 --model 'WN + RW' --to kalibr");
  ASSERT_EQ(direct.status, 0) << direct.errors;
  ASSERT_EQ(run("fit g.h5 --model 'WN + RW' --json > fit.json").status, 0);
  const Outcome from_fit = run("export fit.json --to kalibr --out imu.yaml");
  ASSERT_EQ(from_fit.status, 0) << from_fit.errors;
  EXPECT_EQ(from_fit.out, "");
  const std::string file = read("imu.yaml");
  for (const char* const key : {"gyroscope_noise_density", "gyroscope_random_walk"}) {
    EXPECT_GT(value_of(file, key), 0.0) << file;
    EXPECT_EQ(value_of(file, key), value_of(direct.out, key)) << key;
  }
  EXPECT_NEAR(value_of(file, "gyroscope_noise_density"), 1e-4, 3e-6);
  ASSERT_EQ(run("calibrate g.h5 --model 'WN + RW' --no-diagnose --json > cal.json").status, 0);
  const Outcome calibrated = run("export cal.json --to kalibr");
  ASSERT_EQ(calibrated.status, 0) << calibrated.errors;
  EXPECT_EQ(value_of(calibrated.out, "gyroscope_random_walk"),
            value_of(file, "gyroscope_random_walk"));
}

TEST_F(ExportCommand, StatesTheHashOfItsSource) {
  simulate();
  const Outcome text = run("export g.h5 --model 'WN + RW' --to ros");
  ASSERT_EQ(text.status, 0) << text.errors;
  const std::string sum = run("--version > /dev/null; sha256sum g.h5").out;
  ASSERT_GT(sum.size(), 64U);
  EXPECT_NE(text.out.find(sum.substr(0, 64)), std::string::npos) << text.out << sum;
}

TEST_F(ExportCommand, RefusesWhatItCannotWrite) {
  simulate();
  const Outcome unknown = run("export g.h5 --to nothing");
  EXPECT_EQ(unknown.status, 2);
  EXPECT_NE(unknown.errors.find("kalibr"), std::string::npos) << unknown.errors;
  const Outcome none = run("export g.h5 --model 'WN + RW' --to isaac-sim");
  EXPECT_EQ(none.status, 1);
  EXPECT_NE(none.errors.find("no noise fields"), std::string::npos) << none.errors;
  EXPECT_EQ(run("export g.h5 --to kalibr --horizon 10..1").status, 2);
  ASSERT_EQ(run("wv g.h5 --json > wv.json").status, 0);
  const Outcome json = run("export wv.json --to kalibr");
  EXPECT_EQ(json.status, 1);
  EXPECT_NE(json.errors.find("not the JSON of imunoise calibrate, fit or array"), std::string::npos)
      << json.errors;
}

TEST_F(ExportCommand, ArraysAsMatricesWithTheirVirtualSensor) {
  for (const char* const one : {"1", "2"})
    ASSERT_EQ(run(std::string("simulate --model 'WN(sigma2=1e-6) + RW(gamma2=1e-10)' --rate 100 "
                              "--samples 20000 --unit rad/s --seed ") +
                  one + " --channel gyro_" + one + " --out g" + one + ".csv")
                  .status,
              0);
  // One file with both channels.
  const Outcome joined =
      run("--version > /dev/null; grep -v '^#' g1.csv | cut -d, -f2 > a; "
          "grep -v '^#' g2.csv | cut -d, -f2 > b; paste -d, a b > both.csv; "
          "head -3 both.csv");
  const Outcome fitted =
      run("array both.csv --rate 100 --unit rad/s --model 'WN + RW[corr]' --json > array.json");
  ASSERT_EQ(fitted.status, 0) << fitted.errors << joined.out;
  const Outcome text = run("export array.json --to kf-json");
  ASSERT_EQ(text.status, 0) << text.errors;
  for (const char* const part : {"\"name\": \"array\"", "\"name\": \"virtual\"", "\"Phi\""})
    EXPECT_NE(text.out.find(part), std::string::npos) << text.out;
  const Outcome refused = run("export array.json --to kalibr");
  EXPECT_EQ(refused.status, 1);
  EXPECT_NE(refused.errors.find("kf-json"), std::string::npos) << refused.errors;
}

// NumPy itself reads the archive.
TEST_F(ExportCommand, NumPyReadsItsMatrices) {
  if (std::system("/usr/bin/python3 -c 'import numpy' 2>/dev/null") != 0)
    GTEST_SKIP() << "no NumPy: install python3-numpy";
  simulate();
  ASSERT_EQ(run("export g.h5 --model 'WN + RW' --to kf-numpy --out kf.npz").status, 0);
  const Outcome read =
      run("--version > /dev/null; /usr/bin/python3 -c \"import numpy as np; a = np.load('kf.npz'); "
          "print(a['gyro_x.Phi'].shape, a['gyro_x.states'][0].decode(), a['gyro_x.R'][0, 0] > 0, "
          "a['gyro_x.H'])\"");
  EXPECT_NE(read.out.find("(1, 1) gyro_x.bias True [[1.]]"), std::string::npos)
      << read.out << read.errors;
}

TEST_F(ExportCommand, HelpListsEveryProgram) {
  const Outcome help = run("export --help");
  for (const char* const name : {"kalibr", "px4", "navego", "isaac-sim"})
    EXPECT_NE(help.out.find(std::string("  ") + name + " "), std::string::npos) << help.out;
}

}  // namespace
}  // namespace imunoise::testing
