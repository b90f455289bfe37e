// The matrices of a filter imply the wavelet variances of the model: computed exactly, by carrying
// the covariance of states and Haar sums through 2m steps.

#include <gtest/gtest.h>

#include <cmath>

#include "study/export/whole/array_states.h"

namespace imunoise::testing {
namespace {

constexpr Hertz kHz{50.0};

// Cov of W(m) over all outputs: the state is extended by a sum of each output, with weight -1 for m
// steps and 1 for the next m.
Eigen::MatrixXd implied(const study::StateSpace& s, int m) {
  const Eigen::Index n = s.phi.rows();
  const Eigen::Index outputs = s.h.rows();
  Eigen::MatrixXd p = Eigen::MatrixXd::Zero(n + outputs, n + outputs);
  p.topLeftCorner(n, n) = s.p0;
  for (int step = 0; step < 2 * m; ++step) {
    const double sign = step < m ? -1.0 : 1.0;
    Eigen::MatrixXd f = Eigen::MatrixXd::Identity(n + outputs, n + outputs);
    f.topLeftCorner(n, n) = s.phi;
    f.bottomLeftCorner(outputs, n) = sign * s.h;
    p = (f * p * f.transpose()).eval();
    p.topLeftCorner(n, n) += s.q;
    p.bottomRightCorner(outputs, outputs) += s.r;
  }
  return p.bottomRightCorner(outputs, outputs) / (4.0 * m * m);
}

void expect_same(const std::string& text, double tolerance, int first = 1) {
  SCOPED_TRACE(text);
  const Model model = parse_model(text, kHz).value();
  const auto system = study::state_space(model, "gyro_x", kHz);
  ASSERT_TRUE(system) << system.error().message;
  for (int m = first; m <= 256; m *= 2) {
    const double expected = variance(model, Eigen::ArrayXd::Constant(1, m))(0);
    EXPECT_NEAR(implied(*system, m)(0, 0), expected, tolerance * expected) << "m = " << m;
  }
}

TEST(StateSpace, ImpliesTheWaveletVarianceOfEveryProcess) {
  for (const char* const text :
       {"WN(sigma2=2)", "QN(q2=3)", "RW(gamma2=0.5)", "DR(omega2=0.25)", "AR1(sigma2=2, phi=0.9)",
        "AR1(sigma2=2, phi=-0.4)", "GM(sigma2=2, tc=0.7)", "AR2(sigma2=1, rho1=0.8, phi2=-0.6)",
        "RES(sigma2=1, r=0.95, omega=0.7)", "MA(2, sigma2=1, theta1=0.4, theta2=-0.3)",
        "MAVG(5, sigma2=2)", "BARTLETT(4, sigma2=2)", "PL(a2=2, slope=0.8)",
        "VOIGT(sigma2=1, r=0.95, omega=0.7, spread=0.05)", "LOWPASS(3, sigma2=2, omega=0.4)",
        "BUTTERWORTH(2, sigma2=2, omega=0.4)", "BUTTERWORTH(3, sigma2=2, omega=2.2)",
        "QN(q2=3) + WN(sigma2=2) + AR1(sigma2=0.1, phi=0.99) + RW(gamma2=1e-3) + "
        "DR(omega2=1e-6)"}) {
    expect_same(text, 1e-9);
  }
}

// A sum of Markov processes is 1/f itself; Kasdin's recursion differs at the first scales.
TEST(StateSpace, FlickerWithinOneAndAHalfPerCent) { expect_same("FN(b2=2)", 0.015, 16); }

TEST(StateSpace, WalkAndRampShareOneBias) {
  const Model model = parse_model("RW(gamma2=1) + DR(omega2=1) + RW(gamma2=2)", kHz).value();
  const auto system = study::state_space(model, "x", kHz).value();
  EXPECT_EQ(system.states, (std::vector<std::string>{"x.bias", "x.slope"}));
  EXPECT_DOUBLE_EQ(system.q(0, 0), 3.0);
  EXPECT_DOUBLE_EQ(system.phi(0, 1), 1.0 / kHz.value);
}

TEST(StateSpace, QuantisationNoiseIsNeverInR) {
  const auto system = study::state_space(parse_model("QN(q2=3)", kHz).value(), "x", kHz).value();
  EXPECT_EQ(system.r(0, 0), 0.0);
  EXPECT_EQ(system.states.size(), 2U);
}

TEST(StateSpace, ArrayHasCorrelatedSharedAndOwnProcesses) {
  const Model written =
      parse_array_model("WN(sigma2=1) + AR1(sigma2=0.2, phi=0.9)[all] + RW[corr]", kHz).value();
  ArrayModel model = expand(written, {3, {}});
  for (Latent& latent : model.latents) {
    if (!latent.matrix()) continue;
    latent.power.resize(3, 3);
    latent.power << 2.0, 1.0, -0.5, 1.0, 3.0, 0.2, -0.5, 0.2, 1.0;
    latent.power *= 1e-2;
  }
  const auto system = study::state_space(model, {"a", "b", "c"}, kHz);
  ASSERT_TRUE(system) << system.error().message;
  EXPECT_EQ(system->states.size(), 4U);
  const Scales scales({1, 4, 16, 64});
  const std::vector<Eigen::MatrixXd> expected = covariance(model, scales);
  const Eigen::Vector3d weights(0.2, 0.5, 0.3);
  const study::StateSpace one = study::virtual_output(*system, weights);
  for (std::size_t i = 0; i < scales.size(); ++i) {
    const Eigen::MatrixXd found = implied(*system, static_cast<int>(scales[i]));
    EXPECT_LT((found - expected[i]).norm(), 1e-10 * expected[i].norm()) << scales[i];
    const double quiet = weights.dot(expected[i] * weights);
    EXPECT_NEAR(implied(one, static_cast<int>(scales[i]))(0, 0), quiet, 1e-10 * quiet);
  }
}

// As imunoise array reports it, with a process of a group and a virtual sensor.
TEST(StateSpace, OfTheReportOfAnArray) {
  v1::ArrayReport report;
  report.set_model("WN + AR1[group] + RW[corr]");
  report.set_rate_hz(50.0);
  for (const char* const name : {"a", "b", "c"}) report.add_sensors(name);
  const auto add = [&](const char* term, const char* parameter, double value,
                       std::initializer_list<const char*> sensors) {
    v1::ArrayParameter& to = *report.add_parameters();
    to.set_term(term);
    to.set_parameter(parameter);
    to.set_value(value);
    for (const char* const one : sensors) to.add_sensors(one);
  };
  add("WN", "sigma2", 1.0, {"a"});
  add("WN", "sigma2", 2.0, {"b"});
  add("WN", "sigma2", 3.0, {"c"});
  add("AR1[group]", "sigma2", 0.5, {"a", "c"});
  add("AR1[group]", "phi", 0.9, {"a", "c"});
  add("AR1[group]", "sigma2", 0.25, {"b"});
  add("AR1[group]", "phi", 0.8, {"b"});
  add("RW[corr]", "gamma2", 0.1, {"a"});
  add("RW[corr]", "gamma2", 0.2, {"b"});
  add("RW[corr]", "gamma2", 0.3, {"c"});
  add("RW[corr]", "gamma2", 0.05, {"a", "b"});
  for (const char* const name : {"a", "b", "c"}) {
    v1::SensorWeight& weight = *report.mutable_virtual_sensor()->add_weights();
    weight.set_sensor(name);
    weight.set_weight(1.0 / 3.0);
  }
  const auto systems = study::array_systems(report);
  ASSERT_TRUE(systems) << systems.error().message;
  ASSERT_EQ(systems->size(), 2U);
  const study::StateSpace& array = systems->front();
  EXPECT_EQ(array.states.size(), 5U);
  EXPECT_EQ(array.r.diagonal(), Eigen::Vector3d(1.0, 2.0, 3.0));
  const int m = 32;
  const Eigen::MatrixXd found = implied(array, m);
  const Model a =
      parse_model("WN(sigma2=1) + AR1(sigma2=0.5, phi=0.9) + RW(gamma2=0.1)", kHz).value();
  const Eigen::ArrayXd at = Eigen::ArrayXd::Constant(1, m);
  EXPECT_NEAR(found(0, 0), variance(a, at)(0), 1e-10);
  EXPECT_NEAR(found(0, 1), variance(Process(RandomWalk{0.05}), at)(0), 1e-10);
  EXPECT_NEAR(found(0, 2), variance(Process(Ar1{0.5, 0.9}), at)(0), 1e-10);
  EXPECT_NEAR(implied(systems->back(), m)(0, 0), found.mean(), 1e-10);
  report.mutable_parameters(0)->set_parameter("unknown");
  EXPECT_FALSE(study::array_systems(report));
}

TEST(StateSpace, LongFiltersAreRefused) {
  const auto system = study::state_space(parse_model("MAVG(100, sigma2=2)", kHz).value(), "x", kHz);
  ASSERT_FALSE(system);
  EXPECT_NE(system.error().message.find("100 taps"), std::string::npos);
}

}  // namespace
}  // namespace imunoise::testing
