// Whittle's likelihood against what is known of it in closed form.

#include "core/estimate/whittle.h"

#include <gtest/gtest.h>

#include <cmath>
#include <numbers>
#include <numeric>

#include "core/support/linear_algebra.h"

namespace imunoise {
namespace {

constexpr Hertz kRate{100.0};
constexpr std::size_t kSamples = 1 << 14;

Model model_of(const char* text) { return parse_model(text, kRate).value(); }

Model freed(Model model) {
  for (Term& term : model.terms) term.given.assign(term.given.size(), false);
  return model;
}

// Bands whose power is the model's spectrum, as if averaged over endless repetition.
BandedPower theory(const Model& model) {
  BandedPower out = bands_of(kSamples, kRate);
  for (Eigen::Index b = 0; b < out.frequency.size(); ++b) {
    for (const Term& term : model.terms) out.power(b) += spectrum(term.process, out.frequency(b));
  }
  return out;
}

std::vector<double> all_values(const Model& model) {
  std::vector<double> out;
  for (const Term& term : model.terms) {
    for (const double v : values(term.process)) out.push_back(v);
  }
  return out;
}

Model with_values(Model model, const std::vector<double>& all) {
  auto next = all.begin();
  for (Term& term : model.terms) {
    const auto size = static_cast<std::ptrdiff_t>(term.given.size());
    set_values(term.process, std::vector<double>(next, next + size));
    next += size;
  }
  return model;
}

class WhittleLaw : public ::testing::TestWithParam<const char*> {};

TEST_P(WhittleLaw, InformationIsTheCurvatureOfItsObjective) {
  const Model truth = model_of(GetParam());
  const BandedPower bands = theory(truth);
  const std::vector<double> at = all_values(truth);
  std::vector<Eigen::Index> columns(at.size());
  std::iota(columns.begin(), columns.end(), 0);
  const Eigen::MatrixXd information = whittle_information(truth, std::span(&bands, 1), columns);
  const auto objective = [&](std::size_t i, double hi, std::size_t j, double hj) {
    std::vector<double> moved = at;
    moved[i] += hi;
    moved[j] += hj;
    return whittle_objective(with_values(truth, moved), std::span(&bands, 1));
  };
  const Eigen::VectorXd error = information.diagonal().cwiseSqrt().cwiseInverse();
  for (std::size_t i = 0; i < at.size(); ++i) {
    for (std::size_t j = i; j < at.size(); ++j) {
      const double a = 0.05 * error(static_cast<Eigen::Index>(i));
      const double b = 0.05 * error(static_cast<Eigen::Index>(j));
      const double curvature = (objective(i, a, j, b) - objective(i, a, j, -b) -
                                objective(i, -a, j, b) + objective(i, -a, j, -b)) /
                               (4.0 * a * b);
      // Relative to the diagonal; third derivatives leave h²/6 of it.
      const double scale =
          1.0 / (error(static_cast<Eigen::Index>(i)) * error(static_cast<Eigen::Index>(j)));
      EXPECT_NEAR(curvature / scale,
                  information(static_cast<Eigen::Index>(i), static_cast<Eigen::Index>(j)) / scale,
                  2e-3)
          << i << " " << j;
    }
  }
}

TEST_P(WhittleLaw, FindsTheModelThatTheBandsComeFrom) {
  const Model truth = model_of(GetParam());
  const BandedPower bands = theory(truth);
  std::vector<double> start = all_values(truth);
  for (std::size_t i = 0; i < start.size(); ++i) {
    // φ, r and such stay inside (0, 1); powers are halved or doubled.
    start[i] = start[i] < 1.0 && start[i] > 0.8 ? 1.0 - 1.3 * (1.0 - start[i])
                                                : start[i] * (i % 2 == 0 ? 0.6 : 1.6);
  }
  const WhittleEstimate found = whittle(freed(with_values(truth, start)), std::span(&bands, 1));
  EXPECT_EQ(found.termination, Termination::kConverged);
  const std::vector<double> values = all_values(found.model);
  const std::vector<double> wanted = all_values(truth);
  for (std::size_t i = 0; i < wanted.size(); ++i) {
    EXPECT_NEAR(values[i] / wanted[i], 1.0, 1e-3) << GetParam() << " " << i;
  }
}

INSTANTIATE_TEST_SUITE_P(Models, WhittleLaw,
                         ::testing::Values("WN(sigma2=2) + RW(gamma2=1e-3)",
                                           "AR1(sigma2=0.05, phi=0.97) + WN(sigma2=1)",
                                           "QN(q2=4) + WN(sigma2=1) + RW(gamma2=1e-3)",
                                           "RES(sigma2=0.1, r=0.98, omega=0.9) + WN(sigma2=1)",
                                           "WN(sigma2=1) + FN(b2=0.5)"));

TEST(Whittle, OfWhiteNoiseIsItsMeanSquare) {
  BandedPower bands = bands_of(kSamples, kRate);
  bands.power = 3.0 + bands.frequency.cycles().sin();
  const Model white = freed(model_of("WN(sigma2=1)"));
  const WhittleEstimate found = whittle(white, std::span(&bands, 1));
  const double mean = (bands.count * bands.power).sum() / bands.count.sum();
  EXPECT_NEAR(std::get<WhiteNoise>(found.model.terms[0].process).sigma2, mean, 1e-9);
  const double information = whittle_information(found.model, std::span(&bands, 1), {0})(0, 0);
  EXPECT_NEAR(information, 0.5 * bands.count.sum() / (mean * mean), 1e-6 * information);
}

TEST(Whittle, PutsAPowerThatIsNotThereAtZero) {
  const BandedPower bands = theory(model_of("WN(sigma2=1)"));
  const Model start = freed(model_of("QN(q2=0.1) + WN(sigma2=1) + RW(gamma2=1e-6)"));
  const Model found = whittle(start, std::span(&bands, 1)).model;
  EXPECT_LT(std::get<QuantisationNoise>(found.terms[0].process).q2, 1e-9);
  EXPECT_LT(std::get<RandomWalk>(found.terms[2].process).gamma2, 1e-12);
}

// A start whose shape is at the end of its scale, with and without power.
TEST(Whittle, FindsAShapeThatTheStartDoesNotFeel) {
  const Model truth = freed(model_of("AR1(sigma2=0.05, phi=0.97) + WN(sigma2=1)"));
  const BandedPower bands = theory(truth);
  for (const double power : {0.0, 0.01}) {
    const Model start = with_values(truth, {power, 1.0 - 1e-12, 1.2});
    const std::vector<double> found = all_values(whittle(start, std::span(&bands, 1)).model);
    EXPECT_NEAR(found[0], 0.05, 1e-5) << power;
    EXPECT_NEAR(found[1], 0.97, 1e-5) << power;
  }
}

TEST(Whittle, FindsRampsThatRunEitherWay) {
  const Model truth = model_of("WN(sigma2=1)");
  std::vector<BandedPower> replicates(2, theory(truth));
  const double slopes[] = {3e-4, -3e-4};
  for (std::size_t k = 0; k < 2; ++k) {
    BandedPower& bands = replicates[k];
    bands.ramp_cross = slopes[k] * bands.ramp_power;
    bands.power += slopes[k] * slopes[k] * bands.ramp_power;
  }
  const Model found = whittle(freed(model_of("WN(sigma2=2) + DR(omega2=1e-12)")), replicates).model;
  EXPECT_NEAR(std::get<RateRamp>(found.terms[1].process).omega2, 9e-8, 1e-12);
  EXPECT_NEAR(std::get<WhiteNoise>(found.terms[0].process).sigma2, 1.0, 1e-9);
}

TEST(Whittle, KeepsWhatIsGiven) {
  const BandedPower bands = theory(model_of("WN(sigma2=1) + RW(gamma2=1e-3)"));
  Model start = model_of("WN(sigma2=1.5) + RW");
  const Model found = whittle(start, std::span(&bands, 1)).model;
  EXPECT_EQ(std::get<WhiteNoise>(found.terms[0].process).sigma2, 1.5);
}

double power_of_resonance(const Model& model) {
  constexpr int kGrid = 1 << 18;
  const Frequencies f(Eigen::ArrayXd::LinSpaced(kGrid, 0.5, kGrid - 0.5) / (2.0 * kGrid));
  double out = 0.0;
  for (const Term& term : model.terms) {
    if (std::holds_alternative<Resonance>(term.process)) out += spectrum(Model{{term}}, f).mean();
  }
  return out;
}

// A wave is sharper than any band. Were the peak, too, it could have any power, as long as it lies
// between the middles of two bands. (A peak of half a band's width has a half of its power in the
// band that it lies in the middle of.)
TEST(Whittle, APeakThatIsSharperThanABandKeepsItsPower) {
  constexpr double kAmplitude = 0.3;
  constexpr double kPower = 0.5 * kAmplitude * kAmplitude;
  for (const double cycles : {0.1571, 0.15735, 0.1576, 0.15785}) {
    std::vector<double> x = simulate(model_of("WN(sigma2=1)"), kSamples, 8401, 0);
    for (std::size_t t = 0; t < kSamples; ++t)
      x[t] += kAmplitude * std::sin(2.0 * std::numbers::pi * cycles * static_cast<double>(t));
    const BandedPower bands = banded_power(Signal(std::span<const double>(x), kRate));
    Model start = freed(model_of("WN(sigma2=1) + RES(sigma2=1, r=0.998, omega=1)"));
    std::vector<double> peak{1.0, 0.998, 2.0 * std::numbers::pi * cycles};
    set_values(start.terms[1].process, peak);
    peak[0] = kPower / power_of_resonance(start);
    set_values(start.terms[1].process, peak);
    const Model found = whittle(start, std::span(&bands, 1)).model;
    EXPECT_NEAR(std::log2(power_of_resonance(found) / kPower), 0.0, 1.0) << cycles;
  }
}

}  // namespace
}  // namespace imunoise
