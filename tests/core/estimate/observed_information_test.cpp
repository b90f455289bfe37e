// Newton's steps: spectra to second order, and an information that observation has corrected.

#include <gtest/gtest.h>

#include <cmath>

#include "core/estimate/believed_information.h"
#include "core/estimate/fisher_scoring.h"
#include "core/estimate/searched_parameter.h"
#include "core/estimate/spectral_expansion.h"
#include "core/model/grammar.h"

namespace imunoise {
namespace {

class SpectrumOf : public ::testing::TestWithParam<const char*> {};

// Against differences over three times the step, whose error at the sharpest peak is about
// 2e-5 of the spectrum.
TEST_P(SpectrumOf, BendsAsItsSlopesChange) {
  const Process process = parse_model(GetParam(), Hertz{1.0}).value().terms.front().process;
  const Frequencies frequency(Eigen::ArrayXd::LinSpaced(50, 0.001, 0.499));
  std::vector<std::size_t> parameters;
  for (std::size_t p = 0; p < values(process).size(); ++p) parameters.push_back(p);
  const SpectralExpansion expansion(process, parameters, frequency,
                                    SpectralExpansion::Order::kSecond);
  const double level = spectrum(process, frequency).abs().maxCoeff();
  constexpr double kStep = 3e-4;
  for (const std::size_t p : parameters) {
    const Eigen::ArrayXd slope = searched_slope(process, p, frequency);
    EXPECT_LT((expansion.slopes[p] - slope).abs().maxCoeff(), 1e-8 * level) << p;
    for (const std::size_t q : parameters) {
      const auto slope_at = [&](double step) {
        Process moved = process;
        set_searched(moved, q, searched(process, q) + step);
        return searched_slope(moved, p, frequency);
      };
      const Eigen::ArrayXd bend = (slope_at(kStep) - slope_at(-kStep)) / (2.0 * kStep);
      EXPECT_LT((expansion.bend(p, q) - bend).abs().maxCoeff(), 1e-4 * level) << p << ' ' << q;
    }
  }
}

INSTANTIATE_TEST_SUITE_P(Processes, SpectrumOf,
                         ::testing::Values("WN(sigma2=2)", "AR1(sigma2=2, phi=0.9)",
                                           "RES(sigma2=2, r=0.8, omega=1)",
                                           "AR2(sigma2=2, rho1=0.5, phi2=-0.6)",
                                           "VOIGT(sigma2=2, r=0.9, omega=1, spread=0.1)"));

Eigen::MatrixXd two(double a, double b, double c) {
  return (Eigen::MatrixXd(2, 2) << a, b, b, c).finished();
}

TEST(BelievedInformation, IsFishersWhereNothingElseIsKnown) {
  const Eigen::MatrixXd fisher = two(4.0, 1.0, 9.0);
  EXPECT_LT((BelievedInformation(fisher, {}).damped(0.0) - fisher).norm(), 1e-12);
  EXPECT_LT((BelievedInformation(fisher, {}).damped(2.0) - 3.0 * fisher).norm(), 1e-12);
}

TEST(BelievedInformation, IsWhatWasObservedWhereThatIsPositive) {
  const Eigen::MatrixXd observed = two(40.0, -3.0, 7.0);
  const Eigen::MatrixXd fisher = two(4.0, 1.0, 9.0);
  const Eigen::MatrixXd found = BelievedInformation(fisher, observed - fisher).damped(0.0);
  EXPECT_LT((found - observed).norm(), 1e-11);
}

TEST(BelievedInformation, TurnsRoundWhatCurvesTheWrongWay) {
  const Eigen::MatrixXd fisher = two(4.0, 0.0, 9.0);
  const Eigen::MatrixXd found =
      BelievedInformation(fisher, two(-20.0, 0.0, -8.9)).damped(0.0);  // observed: -16 and 0.1
  EXPECT_LT((found - two(16.0, 0.0, 0.9)).norm(), 1e-12);              // at least a tenth of 9
}

TEST(BelievedInformation, IsNothingWhereNothingIsFelt) {
  const Eigen::MatrixXd none = Eigen::MatrixXd::Zero(2, 2);
  EXPECT_EQ(BelievedInformation(none, none).damped(1.0), none);
}

TEST(BelievedInformation, LeavesFlatWhatFishersInformationCannotTellApart) {
  const Eigen::MatrixXd fisher = two(1.0, 1.0, 1.0);
  const Eigen::MatrixXd found = BelievedInformation(fisher, two(5.0, 0.0, 5.0)).damped(1.0);
  EXPECT_NEAR((found * Eigen::Vector2d(1.0, -1.0)).norm(), 0.0, 1e-12);
}

// Rosenbrock's valley as a likelihood, -log L = (10 (y - x²))²/2 + (1 - x)²/2: Fisher's information
// is that of the residuals' slopes. The way from (-1.2, 1) is long and bent (Moré, Garbow
// & Hillstrom 1981, problem 1).
TEST(FisherScoring, FollowsABentValley) {
  int asked = 0;
  Likelihood valley;
  valley.cones = {Likelihood::kFree, Likelihood::kFree};
  const auto residuals = [](const Eigen::VectorXd& at) {
    return Eigen::Vector2d(10.0 * (at(1) - at(0) * at(0)), 1.0 - at(0));
  };
  valley.objective = [&](const Eigen::VectorXd& at) {
    ++asked;
    return 0.5 * residuals(at).squaredNorm();
  };
  valley.curvature = [&](const Eigen::VectorXd& at, Asked how) {
    const Eigen::Vector2d r = residuals(at);
    const Eigen::MatrixXd slopes =
        (Eigen::MatrixXd(2, 2) << -20.0 * at(0), 10.0, -1.0, 0.0).finished();
    Curvature out;
    out.information = slopes.transpose() * slopes;
    out.score = -slopes.transpose() * r;
    if (how == Asked::kObserved) out.correction = two(-20.0 * r(0), 0.0, 0.0);
    return out;
  };
  const Scored found = fisher_scoring(valley, Eigen::Vector2d(-1.2, 1.0));
  EXPECT_EQ(found.termination, Termination::kConverged);
  EXPECT_NEAR(found.at(0), 1.0, 1e-3);
  EXPECT_NEAR(found.at(1), 1.0, 2e-3);
  EXPECT_LT(asked, 60);
}

// A likelihood whose curvature is twenty times Fisher's information, as under a model that misses
// something: steps by the latter go twenty times too far. The first one is damped three times; then
// Newton's converge cubically, because the curve is even. Fisher's alone ask 14 times.
TEST(FisherScoring, BelievesTheObservedCurvature) {
  constexpr double kTimes = 20.0;
  int asked = 0;
  Likelihood sharp;
  sharp.cones = {Likelihood::kFree};
  sharp.objective = [&](const Eigen::VectorXd& at) {
    ++asked;
    return kTimes * (std::cosh(at(0)) - 1.0);
  };
  sharp.curvature = [&](const Eigen::VectorXd& at, Asked how) {
    Curvature out;
    out.information = Eigen::MatrixXd::Ones(1, 1);
    out.score = Eigen::VectorXd::Constant(1, -kTimes * std::sinh(at(0)));
    if (how == Asked::kObserved)
      out.correction = Eigen::MatrixXd::Constant(1, 1, kTimes * std::cosh(at(0)) - 1.0);
    return out;
  };
  const Scored found = fisher_scoring(sharp, Eigen::VectorXd::Constant(1, 0.9));
  EXPECT_NEAR(found.at(0), 0.0, 1e-4);
  EXPECT_LT(asked, 12);
}

}  // namespace
}  // namespace imunoise
