// Processes against arithmetic of 120 digits, and against the peers' theory where the peers are
// right.

#include <gtest/gtest.h>

#include <cmath>

#include "core/process/process.h"
#include "tests/support/golden.h"

namespace imunoise {
namespace {

using testing::read_json;

double at(const Process& process, double m) {
  return variance(process, Eigen::ArrayXd::Constant(1, m))(0);
}

TEST(GoldenProcess, Ar1InEveryRow) {
  IMUNOISE_NEEDS("golden/ar1_wv_exact_and_peer_error.json");
  int rows = 0;
  const auto exact_rows = read_json("golden/ar1_wv_exact_and_peer_error.json");
  for (const auto& row : exact_rows) {
    const double phi = 1.0 - row["one_minus_phi"].get<double>();
    for (const auto& [level, exact] : row["exact"].items()) {
      const double m = std::ldexp(1.0, std::stoi(level) - 1);
      EXPECT_NEAR(at(Ar1{1.0, phi}, m) / exact.get<double>(), 1.0, 1e-10) << phi << " " << m;
      ++rows;
    }
  }
  IMUNOISE_NEEDS("golden/reference.json");
  const auto reference = read_json("golden/reference.json");
  for (const auto& row : reference["ar1"]) {
    const Ar1 process{row["s2"].get<double>(), row["phi"].get<double>()};
    EXPECT_NEAR(at(process, row["m"].get<double>()) / row["nu"].get<double>(), 1.0, 1e-10)
        << row.dump();
    ++rows;
  }
  EXPECT_GE(rows, 70 + 81);
}

TEST(GoldenProcess, ResonanceAndFlicker) {
  IMUNOISE_NEEDS("golden/reference.json");
  const auto golden = read_json("golden/reference.json");
  for (const auto& row : golden["ar2"]) {
    const Resonance process{row["s2"].get<double>(), row["r"].get<double>(),
                            row["omega"].get<double>()};
    EXPECT_NEAR(at(process, row["m"].get<double>()) / row["nu"].get<double>(), 1.0, 1e-8)
        << row.dump();
  }
  for (const auto& row : golden["fn"]) {
    const double b = row["B"].get<double>();
    EXPECT_NEAR(at(Flicker{b * b}, row["m"].get<double>()) / row["kasdin"].get<double>(), 1.0, 1e-8)
        << row.dump();
  }
}

TEST(GoldenProcess, PeersTheoryWhereItHolds) {
  IMUNOISE_NEEDS("golden/wv_small_and_theory.json");
  const auto theory = read_json("golden/wv_small_and_theory.json")["theory"];
  const std::vector<std::pair<std::string, Process>> pairs = {
      {"wn_1", WhiteNoise{1.0}},
      {"qn_1", QuantisationNoise{1.0}},
      {"rw_1", RandomWalk{1.0}},
      {"dr_1", RateRamp{1.0}},
      {"ar1_0.5", Ar1{1.0, 0.5}},
      {"ar1_neg0.5", Ar1{1.0, -0.5}},
      {"ma1_0.5", MovingAverage{1.0, {0.5}}}};
  for (const auto& [name, process] : pairs) {
    for (std::size_t i = 0; i < theory["tau"].size(); ++i) {
      const double m = theory["tau"][i].get<double>() / 2.0;
      EXPECT_NEAR(at(process, m) / theory[name][i].get<double>(), 1.0, 1e-12) << name << " " << m;
    }
  }
}

}  // namespace
}  // namespace imunoise
