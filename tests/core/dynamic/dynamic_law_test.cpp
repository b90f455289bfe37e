// Laws of models whose parameters follow a covariate.

#include <gtest/gtest.h>

#include <cmath>
#include <cstdio>

#include "core/estimate/profile.h"
#include "core/support/parallel.h"
#include "tests/core/dynamic/rotation_table.h"

namespace imunoise {
namespace {

constexpr Hertz kRate{100};
constexpr const char* kEveryLink =
    "AR1(sigma2~linear, phi~logistic) + GM(tc~exp) + QN(q2~exp) + RW(gamma2~linear) + "
    "AR1(sigma2=0.01, phi~logistic) + WN";

// A model with every kind of trend, with values and slopes.
Model trended() {
  Model out = parse_dynamic_model(kEveryLink, kRate).value();
  const auto set = [&](std::size_t t, std::vector<double> v, std::vector<double> slopes) {
    set_values(out.terms[t].process, v);
    for (std::size_t p = 0; p < slopes.size(); ++p) out.terms[t].trends[p].slope = slopes[p];
  };
  set(0, {0.02, 0.9}, {0.01, 0.5});
  set(1, {0.1, 3.0}, {0.0, 0.3});
  set(2, {2.0}, {-2.0});
  set(3, {1e-6}, {-0.5e-6});
  set(4, {0.01, -0.3}, {0.0, 0.8});
  set(5, {1.0}, {});
  return out;
}

WaveletVariance theory(const Model& truth, std::size_t samples) {
  WaveletVariance out;
  out.samples = samples;
  out.scales = Scales::for_samples(samples);
  out.rate = kRate;
  out.variance = variance(truth, out.scales.half_widths());
  set_chi_square_interval(out);
  return out;
}

// Moments as if the recordings had been endless, at covariates 10, 20 .. 50.
std::vector<CovariateBin> endless(const Model& truth, std::size_t samples = 1U << 16U) {
  std::vector<CovariateBin> out;
  for (int b = 0; b < 5; ++b) {
    out.push_back({10.0 + 10.0 * b, {theory(model_at(truth, 0.5 * b - 1.0), samples)}});
  }
  return out;
}

Problem problem_of(const Model& model, const std::vector<CovariateBin>& bins) {
  Problem out{model, {}};
  for (const CovariateBin& bin : bins) {
    const auto roots = diagonal_roots(bin.runs);
    for (MomentBlock& block : tied_problem(model, bin.runs, roots).blocks) {
      for (Segment& segment : block.segments) segment.covariate = (bin.covariate - 30.0) / 20.0;
      out.blocks.push_back(std::move(block));
    }
  }
  return out;
}

TEST(Grammar, SaysWhatFollowsTheCovariate) {
  const auto model = parse_dynamic_model(kEveryLink, kRate);
  ASSERT_TRUE(model) << model.error().message;
  EXPECT_EQ(print(*model), kEveryLink);
  EXPECT_EQ(parse_dynamic_model(print(*model), kRate).value(), *model);
  const auto short_form = parse_dynamic_model("2*AR1(phi ~ )+wn(SIGMA2=1)", kRate);
  EXPECT_FALSE(short_form);  // parameters keep their case
  const auto customary = parse_dynamic_model("2*ar1(phi ~ , sigma2~Linear) + wn(sigma2~)", kRate);
  ASSERT_TRUE(customary) << customary.error().message;
  EXPECT_EQ(print(*customary), "2*AR1(sigma2~linear, phi~logistic) + WN(sigma2~exp)");
  EXPECT_EQ(print(with_varying_powers(parse_model("AR1 + WN(sigma2=2)", kRate).value())),
            "AR1(sigma2~exp) + WN(sigma2=2)");
  EXPECT_EQ(print_with_values(model_at(trended(), 1.0)).find('~'), std::string::npos);
  EXPECT_EQ(parse_model("WN(sigma2~)", kRate).error().message,
            "model: parameters follow a covariate only in imunoise dynamic\n  WN(sigma2~)\n"
            "           ^");
  EXPECT_NE(parse_dynamic_model("AR1(phi~exp)", kRate).error().message.find("as logistic"),
            std::string::npos);
  EXPECT_NE(parse_dynamic_model("WN(sigma2~quad)", kRate).error().message.find("exp or linear"),
            std::string::npos);
  for (const char* wrong : {"WN(sigma2~exp=1)", "WN(sigma2=1, sigma2~)", "WN(sigma2~, sigma2~)",
                            "WN(~)", "WN[corr]", "WN(sigma2~5)"}) {
    EXPECT_FALSE(parse_dynamic_model(wrong, kRate)) << wrong;
  }
}

TEST(Trend, MovesEachParameterAlongItsLink) {
  const Model model = trended();
  const auto at = [&](std::size_t term, std::size_t p, double c) {
    return values(process_at(model.terms[term], c))[p];
  };
  EXPECT_NEAR(at(2, 0, 0.5), 2.0 * std::exp(-1.0), 1e-15);
  EXPECT_NEAR(at(3, 0, 1.0), 0.5e-6, 1e-20);
  EXPECT_NEAR(at(1, 1, -1.0), 3.0 * std::exp(-0.3), 1e-14);
  const ParameterScale scale(parameters(model.terms[4].process)[1], 1);
  EXPECT_NEAR(scale.to_scale(at(4, 1, 1.0)) - scale.to_scale(-0.3), 0.8, 1e-9);
  EXPECT_EQ(model_at(model, 0.0).terms[0].process, model.terms[0].process);
}

TEST(Profile, GradientOfTrendsMatchesCentralDifferences) {
  const Model truth = trended();
  std::vector<CovariateBin> bins = endless(truth);
  for (CovariateBin& bin : bins) {  // away from the minimum
    for (Eigen::Index i = 0; i < bin.runs[0].variance.size(); ++i) {
      bin.runs[0].variance(i) *= 1.0 + 0.1 * std::sin(1.7 * static_cast<double>(i) + bin.covariate);
    }
  }
  const Problem problem = problem_of(truth, bins);
  const Profile profile(problem);
  // φ, its slope, tc, its slope, the slope of q2, φ of the given AR1 and its slope.
  ASSERT_EQ(profile.coordinates().size(), 7U);
  std::vector<double> x = profile.coordinates_of(truth);
  for (std::size_t i = 0; i < x.size(); ++i) x[i] += 0.03 * static_cast<double>(i + 1);
  std::vector<double> gradient(x.size());
  profile.at(x, &gradient);
  for (std::size_t i = 0; i < x.size(); ++i) {
    constexpr double kStep = 1e-5;
    std::vector<double> up = x;
    std::vector<double> down = x;
    up[i] += kStep;
    down[i] -= kStep;
    const double expected = (profile.at(up).objective - profile.at(down).objective) / (2.0 * kStep);
    EXPECT_NEAR(gradient[i] / expected, 1.0, 2e-5) << "coordinate " << i;
    EXPECT_GT(std::abs(expected), 1e-6) << "coordinate " << i << " says nothing";
  }
}

TEST(FreeNumbers, JacobianMatchesCentralDifferences) {
  const Model model = trended();
  const std::vector<FreeNumber> numbers = free_numbers(model);
  ASSERT_EQ(numbers.size(), 2U + 2 + 1 + 2 + 2 + 2 + 2 + 1);
  const Eigen::ArrayXd m = Scales::for_samples(4096).half_widths();
  for (const double c : {-1.0, 0.3, 1.0}) {
    const Eigen::MatrixXd found = jacobian(model, numbers, c, m);
    for (std::size_t i = 0; i < numbers.size(); ++i) {
      const FreeNumber& number = numbers[i];
      const ParameterScale scale(parameters(model.terms[number.term].process)[number.parameter],
                                 number.parameter);
      const auto moved = [&](double step) {
        Model out = model;
        Term& term = out.terms[number.term];
        std::vector<double> v = values(term.process);
        if (number.kind == FreeNumber::Kind::kSlope) {
          term.trends[number.parameter].slope += step;
        } else if (number.kind == FreeNumber::Kind::kLevel) {
          v[number.parameter] = scale.to_value(scale.to_scale(v[number.parameter]) + step);
          set_values(term.process, v);
        } else {
          return with_power(model, number, power_of(model, number) + step);
        }
        return out;
      };
      const bool power =
          number.kind != FreeNumber::Kind::kSlope && number.kind != FreeNumber::Kind::kLevel;
      const double step = power ? 1e-3 * values(model.terms[number.term].process)[0] : 1e-5;
      const Eigen::ArrayXd expected =
          (variance(model_at(moved(step), c), m) - variance(model_at(moved(-step), c), m)) /
          (2.0 * step);
      const Eigen::ArrayXd column = found.col(static_cast<Eigen::Index>(i)).array();
      EXPECT_LT((column - expected).abs().maxCoeff(), 1e-6 * expected.abs().maxCoeff() + 1e-300)
          << "number " << i << " at " << c;
      const double faster =
          (values(process_at(moved(step).terms[number.term], c))[number.parameter] -
           values(process_at(moved(-step).terms[number.term], c))[number.parameter]) /
          (2.0 * step);
      EXPECT_NEAR(speed(model, number, c), faster, 1e-6 * std::abs(faster) + 1e-9)
          << "number " << i;
    }
  }
}

class TrendExactness : public ::testing::TestWithParam<const char*> {};

TEST_P(TrendExactness, MomentsOfTheTheoryGiveTheTrendsBack) {
  Model truth = parse_dynamic_model(GetParam(), kRate).value();
  Model open = truth;
  double slope = 0.7;
  for (Term& term : truth.terms) {
    const std::vector<double> v = values(term.process);
    for (std::size_t p = 0; p < v.size(); ++p) {
      Trend& trend = term.trends[p];
      if (trend.link == Link::kConstant) continue;
      trend.slope = trend.link == Link::kLinear ? 0.6 * v[p] : slope;
      slope = -0.8 * slope;
    }
  }
  const std::vector<CovariateBin> bins = endless(truth);
  const DynamicFit fit = fit_dynamic(open, bins);
  const Eigen::ArrayXd m = bins[0].runs[0].scales.half_widths();
  for (const double c : {-1.0, -0.5, 0.0, 0.5, 1.0}) {
    const Eigen::ArrayXd expected = variance(model_at(truth, c), m);
    const Eigen::ArrayXd found = variance(model_at(fit.model, c), m);
    EXPECT_LT((found / expected - 1.0).abs().maxCoeff(), 1e-5) << GetParam() << " at " << c;
  }
  for (const TrendEstimate& one : fit.trends) {
    const Trend& trend = truth.terms[one.term].trends[one.parameter];
    EXPECT_NEAR(one.slope * 20.0 / trend.slope, 1.0, 1e-3) << GetParam();
    EXPECT_LT(one.test.p_value, 1e-6) << GetParam();
  }
  EXPECT_GT(fit.links.p_value, 0.99);
}

INSTANTIATE_TEST_SUITE_P(Trends, TrendExactness,
                         ::testing::Values("WN(sigma2~exp)", "WN(sigma2~linear) + RW(gamma2~exp)",
                                           "QN(q2~exp) + WN(sigma2~exp)",
                                           "AR1(sigma2~exp, phi~logistic) + WN",
                                           "GM(tc~exp) + WN(sigma2~linear)"));

TEST(FitDynamic, IsThePooledFitWhereNothingMoves) {
  Model truth = parse_model("QN + WN", kRate).value();
  set_values(truth.terms[0].process, std::vector{3.0});
  const DynamicFit fit =
      fit_dynamic(with_varying_powers(parse_model("QN + WN", kRate).value()), endless(truth));
  for (const TrendEstimate& trend : fit.trends) {
    EXPECT_NEAR(trend.slope, 0.0, 1e-6);
    EXPECT_LT(trend.lower, 0.0);
    EXPECT_GT(trend.upper, 0.0);
    EXPECT_GT(trend.test.p_value, 0.99);
  }
}

TEST(FitDynamic, SaysWhatIsNotThere) {
  const Model truth = parse_model("WN", kRate).value();
  for (const char* link : {"exp", "linear"}) {
    const std::string text = std::string("WN(sigma2~) + RW(gamma2~") + link + ")";
    const DynamicFit fit =
        fit_dynamic(parse_dynamic_model(text, kRate).value(), endless(truth, 1U << 14U));
    for (const double rate : {10.0, 30.0, 50.0}) {
      const ParameterEstimate walk = estimates_at(fit, rate)[1].parameters[0];
      EXPECT_EQ(walk.lower, 0.0) << link;
      EXPECT_GT(walk.upper, 1e-12) << link;
      EXPECT_LT(walk.upper, 1e-4) << link;
    }
    EXPECT_GT(fit.trends[1].test.p_value, 0.9) << link;
  }
}

TEST(RotationTable, WhiteNoiseGrowsAndQuantisationNoiseVanishes) {
  constexpr std::uint64_t kSeed = 20261121;
  const auto bins = testing::simulated_table(1U << 14U, kSeed, 0);
  const Model open = parse_dynamic_model(testing::kTableModel, testing::kTableRate).value();
  const DynamicFit fit = fit_dynamic(open, bins);
  for (const double rate : {30.0, 390.0}) {
    const DerivedEstimate walk = estimates_at(fit, rate)[1].derived[0];
    const double truth = testing::table_random_walk(rate) * testing::kRandomWalkUnit;
    EXPECT_NEAR(walk.value / truth, 1.0, 0.05) << rate << ", seed " << kSeed;
    EXPECT_LT(walk.lower, walk.value);
    EXPECT_GT(walk.upper, walk.value);
  }
  const double first = estimates_at(fit, 30.0)[0].parameters[0].value;
  const double last = estimates_at(fit, 390.0)[0].parameters[0].value;
  EXPECT_NEAR(first / 9.8e-6, 1.0, 0.05) << "seed " << kSeed;
  EXPECT_LT(last, 1e-8) << "seed " << kSeed;
  for (const TrendEstimate& trend : fit.trends) EXPECT_LT(trend.test.p_value, 1e-6);
  EXPECT_GT(fit.misfit.p_value, 0.001);
  EXPECT_GT(fit.links.p_value, 0.001);
  // The same bits on one thread.
  const ThreadLimit limit(1);
  const DynamicFit again = fit_dynamic(open, bins);
  EXPECT_EQ(again.model, fit.model);
  EXPECT_EQ(again.covariance, fit.covariance);
}

TEST(RotationTable, AWrongLinkIsNoticed) {
  // What grows exponentially by a factor of nine is no straight line.
  const auto bins = testing::simulated_table(1U << 14U, 20261121, 1);
  const Model open =
      parse_dynamic_model("QN(q2~exp) + WN(sigma2~linear)", testing::kTableRate).value();
  const DynamicFit fit = fit_dynamic(open, bins);
  EXPECT_LT(fit.links.p_value, 1e-6);
  EXPECT_GT(fit.misfit.p_value, 0.001);  // the processes are right all the same
}

}  // namespace
}  // namespace imunoise
