#include <cmath>
#include <nlohmann/json.hpp>

#include "tests/cli/program.h"

namespace imunoise::testing {
namespace {

class WvDeviation : public Program {
 protected:
  // The 1,000 points of NIST SP 1065.
  void write_points() {
    std::ofstream file(folder_ / "nist.csv");
    file.precision(17);
    long long n = 1234567890;
    for (int i = 0; i < 1000; ++i) {
      file << static_cast<double>(n) / 2147483647.0 << "\n";
      n = 16807 * n % 2147483647;
    }
  }
};

TEST_F(WvDeviation, NistPoints) {
  write_points();
  const Outcome allan = run("wv nist.csv --rate 1 --unit rad/s --allan --json");
  ASSERT_EQ(allan.status, 0) << allan.errors;
  const auto report = nlohmann::json::parse(allan.out);
  EXPECT_EQ(report["kind"], "Allan");
  const auto& points = report["points"];
  EXPECT_EQ(points[3]["samples"], 10);
  EXPECT_NEAR(points[0]["deviation"].get<double>(), 2.922319e-1, 5e-8);
  EXPECT_NEAR(points[3]["deviation"].get<double>(), 9.159953e-2, 5e-9);
  EXPECT_LT(points[3]["lower"].get<double>(), 9.159953e-2);
  EXPECT_GT(points[3]["degrees_of_freedom"].get<double>(), 100.0);
  const auto& minimum = report["minimum"];
  EXPECT_NEAR(minimum["bias_instability"].get<double>() * 0.664, minimum["deviation"].get<double>(),
              1e-12);
  const Outcome hadamard = run("wv nist.csv --rate 1 --unit rad/s --hadamard --json");
  ASSERT_EQ(hadamard.status, 0) << hadamard.errors;
  EXPECT_NEAR(nlohmann::json::parse(hadamard.out)["points"][3]["deviation"].get<double>(),
              9.581083e-2, 5e-9);
}

TEST_F(WvDeviation, TableReportAndPicture) {
  write_points();
  const Outcome text = run("wv nist.csv --rate 1 --unit rad/s --allan --report a.html --svg a.svg");
  ASSERT_EQ(text.status, 0) << text.errors;
  for (const char* const part : {"Allan deviation", "degrees of freedom", "minimum / 0.664"})
    EXPECT_NE(text.out.find(part), std::string::npos) << text.out;
  EXPECT_NE(read("a.html").find("Allan deviation"), std::string::npos);
  EXPECT_NE(read("a.svg").find("<svg"), std::string::npos);
  EXPECT_EQ(run("wv nist.csv --rate 1 --svg a.svg").status, 2);
  EXPECT_EQ(run("wv nist.csv --rate 1 --allan --hadamard").status, 2);
  EXPECT_EQ(run("wv nist.csv --rate 1 --allan --per-octave 2").status, 2);
}

TEST_F(WvDeviation, AFitNamesThreeBiasInstabilities) {
  ASSERT_EQ(run("simulate --model 'WN(sigma2=1e-6) + GM(sigma2=1e-8, tc=20) + FN(b2=1e-9)' --rate "
                "50 --samples 60000 --seed 3 --unit rad/s --channel gyro_x --out g.h5")
                .status,
            0);
  const Outcome fit = run("fit g.h5 --model 'WN + GM + FN'");
  ASSERT_EQ(fit.status, 0) << fit.errors;
  // Cells wrap: words that stay together.
  for (const char* const part : {"bias instability", "flicker", "minimum of the Allan", "slowest"})
    EXPECT_NE(fit.out.find(part), std::string::npos) << part << "\n" << fit.out;
  const auto named = nlohmann::json::parse(run("fit g.h5 --model 'WN + GM + FN' --json").out);
  const auto& three = named["bias_instability"];
  ASSERT_EQ(three.size(), 3U);
  EXPECT_EQ(three[0]["kind"], "flicker");
  EXPECT_EQ(three[0]["value"]["symbol"], "B");
  EXPECT_EQ(three[1]["kind"], "minimum");
  // Allan deviation of the budget's lowest scale: √2 of the wavelet deviation, at half its time.
  double lowest = 1e300;
  double tau = 0.0;
  for (std::size_t i = 0; i < named["budget"]["measured"].size(); ++i) {
    const double one = named["budget"]["measured"][i];
    if (one >= lowest) continue;
    lowest = one;
    tau = 0.5 * named["budget"]["scales_s"][i].get<double>();
  }
  EXPECT_NEAR(three[1]["value"]["value"].get<double>(), std::sqrt(2.0 * lowest) / 0.664,
              1e-9 * std::sqrt(lowest));
  EXPECT_DOUBLE_EQ(three[1]["time"]["value"].get<double>(), tau);
  EXPECT_EQ(three[2]["kind"], "markov");
  for (const auto& term : named["terms"]) {
    if (term["name"] != "GM") continue;
    EXPECT_EQ(three[2]["value"], term["coefficients"][0]);
    EXPECT_EQ(three[2]["time"], term["coefficients"][1]);
  }
  const Outcome plain = run("fit g.h5 --model 'WN + RW'");
  EXPECT_NE(plain.out.find("the model has no"), std::string::npos) << plain.out;
}

}  // namespace
}  // namespace imunoise::testing
