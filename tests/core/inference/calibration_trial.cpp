// Size of the test of fit and coverage of the intervals, over many simulated recordings. Every
// share is compared with its nominal value; the allowance is 3.3 binomial standard errors, 1 false
// alarm in 1,000.

#include <gtest/gtest.h>

#include <cstdio>

#include "core/support/parallel.h"
#include "tests/core/inference/simulated_sets.h"

namespace imunoise {
namespace {

constexpr std::uint64_t kSeed = 20'250;
constexpr std::size_t kSets = 1000;

struct Setting {
  const char* truth;
  std::size_t replicates;
  std::size_t samples = 16'384;
  int per_octave = 1;
};

double share(const std::vector<Fit>& fits, const auto& holds) {
  double count = 0.0;
  for (const Fit& fit : fits) count += holds(fit) ? 1.0 : 0.0;
  return count / static_cast<double>(fits.size());
}

double covered(const std::vector<Fit>& fits, std::size_t term, const DerivedQuantity& truth) {
  return share(fits, [&](const Fit& fit) {
    for (const DerivedEstimate& found : fit.derived[term]) {
      if (found.coefficient == truth.coefficient)
        return found.lower <= truth.value && truth.value <= found.upper;
    }
    return false;
  });
}

class Calibration : public ::testing::TestWithParam<Setting> {
 protected:
  static std::vector<Fit> fits(Weighting weighting) {
    const Setting& trial = GetParam();
    const Model truth = testing::model_of(trial.truth);
    std::vector<Fit> out(kSets);
    for_each_index(kSets, [&](std::size_t i) {
      const auto moments =
          testing::simulated_set(truth, std::vector<std::size_t>(trial.replicates, trial.samples),
                                 trial.per_octave, kSeed + i);
      out[i] = infer(mugmwm(testing::freed(truth), moments, weighting), moments);
    });
    return out;
  }

  static void expect_size(const std::vector<Fit>& fits) {
    for (const double nominal : {0.05, 0.01}) {
      const double found =
          share(fits, [&](const Fit& fit) { return fit.goodness.p_value < nominal; });
      std::printf("    size %.1f %% at nominal %.0f %%\n", 100.0 * found, 100.0 * nominal);
      EXPECT_NEAR(found, nominal, testing::binomial_allowance(nominal, kSets)) << GetParam().truth;
    }
  }

  // 95 % intervals cover in `lowest` to 98 % of all sets.
  static void expect_coverage(const std::vector<Fit>& fits, double lowest) {
    const Model truth = testing::model_of(GetParam().truth);
    for (std::size_t t = 0; t < truth.terms.size(); ++t) {
      const Process& process = truth.terms[t].process;
      const std::vector<ParameterInfo> about = parameters(process);
      for (std::size_t p = 0; p < about.size(); ++p) {
        const double value = values(process)[p];
        const double found = share(fits, [&](const Fit& fit) {
          return fit.parameters[t][p].lower <= value && value <= fit.parameters[t][p].upper;
        });
        std::printf("    %s %s covered %.1f %%\n", info(process).name.data(), about[p].name.c_str(),
                    100.0 * found);
        EXPECT_GE(found, lowest) << GetParam().truth << " " << about[p].name;
        EXPECT_LE(found, 0.98) << GetParam().truth << " " << about[p].name;
      }
      for (const DerivedQuantity& quantity : derived(process, testing::kTrialRate)) {
        const double found = covered(fits, t, quantity);
        const CoefficientUnits units = coefficient_units(quantity.coefficient, Quantity::kUnknown);
        std::printf("    %s covered %.1f %%\n", units.symbol.data(), 100.0 * found);
        EXPECT_GE(found, lowest) << GetParam().truth << " " << units.symbol;
        EXPECT_LE(found, 0.98) << GetParam().truth << " " << units.symbol;
      }
    }
  }
};

TEST_P(Calibration, FullWeights) {
  std::printf("%s, %zu replicates, seeds from %llu\n", GetParam().truth, GetParam().replicates,
              static_cast<unsigned long long>(kSeed));
  const std::vector<Fit> all = fits(Weighting::kFull);
  expect_size(all);
  expect_coverage(all, 0.95 - testing::binomial_allowance(0.95, kSets));
}

// Diagonal weights follow the noise of the moments: what happened to come out small weighs more.
// The bias at scales of few degrees of freedom stays however many replicates there are, and the
// intervals, which know the scatter only, cover less.
TEST_P(Calibration, DiagonalWeights) {
  const std::vector<Fit> all = fits(Weighting::kDiagonal);
  expect_size(all);
  expect_coverage(all, 0.87);
}

INSTANTIATE_TEST_SUITE_P(
    Models, Calibration,
    ::testing::Values(Setting{"WN(sigma2=1) + RW(gamma2=1e-3)", 1},
                      Setting{"WN(sigma2=1) + RW(gamma2=1e-3)", 3},
                      Setting{"AR1(sigma2=0.05, phi=0.97) + WN(sigma2=1)", 1},
                      Setting{"AR1(sigma2=0.05, phi=0.97) + WN(sigma2=1)", 3},
                      Setting{"WN(sigma2=1) + QN(q2=3) + RW(gamma2=1e-3)", 1},
                      Setting{"WN(sigma2=1) + QN(q2=3) + RW(gamma2=1e-3)", 3},
                      Setting{"AR1(sigma2=0.2, phi=0.9) + WN(sigma2=1) + RW(gamma2=1e-4)", 1},
                      Setting{"AR1(sigma2=0.2, phi=0.9) + WN(sigma2=1) + RW(gamma2=1e-4)", 3}));

// Between the octaves the moments are strongly correlated; the test must stand that.
TEST(CalibrationDense, FourScalesAnOctave) {
  constexpr std::size_t kFew = 200;
  const Model truth = testing::model_of("AR1(sigma2=0.05, phi=0.97) + WN(sigma2=1)");
  std::vector<Fit> all(kFew);
  for_each_index(kFew, [&](std::size_t i) {
    const auto moments = testing::simulated_set(truth, {100'000}, 4, kSeed + i);
    all[i] = infer(mugmwm(testing::freed(truth), moments, Weighting::kFull), moments);
  });
  const double found = share(all, [](const Fit& fit) { return fit.goodness.p_value < 0.05; });
  std::printf(
      "AR1+WN, T = 100,000, 4 scales an octave: size %.1f %% at nominal 5 %% (%d degrees of "
      "freedom)\n",
      100.0 * found, all[0].goodness.degrees_of_freedom);
  EXPECT_NEAR(found, 0.05, testing::binomial_allowance(0.05, kFew));
}

// A random walk too weak for the recording: at the length that record_longer names it is seen in
// about half of all recordings or more.
TEST(RecordLonger, IsLongEnough) {
  constexpr std::size_t kShort = 8192;
  constexpr std::size_t kRecordings = 200;
  const Model truth = testing::model_of("WN(sigma2=1) + RW(gamma2=3e-7)");
  const Model open = testing::freed(truth);
  std::vector<double> longer(kRecordings);
  for_each_index(kRecordings, [&](std::size_t i) {
    const auto moments = testing::simulated_set(truth, {kShort}, 1, kSeed + i);
    const Fit fit = infer(mugmwm(open, moments, Weighting::kFull), moments);
    longer[i] = record_longer(fit, moments, 1, 0);
  });
  std::vector<double> told;
  for (const double factor : longer) {
    if (factor > 1.0) told.push_back(factor);
  }
  // What it would say if the estimate were the truth, from moments that equal the theory.
  const std::vector<WaveletVariance> moments = {testing::theory(truth, kShort)};
  const Fit ideal = infer(mugmwm(open, moments, Weighting::kFull), moments);
  ASSERT_EQ(ideal.parameters[1][0].observability, Observability::kUpperBound);
  const double factor = record_longer(ideal, moments, 1, 0);
  ASSERT_GT(factor, 1.0);
  const auto length = static_cast<std::size_t>(factor * static_cast<double>(kShort));
  const auto seen_share = [&](std::size_t samples) {
    std::vector<int> seen(kRecordings);
    for_each_index(kRecordings, [&](std::size_t i) {
      const auto at = testing::simulated_set(truth, {samples}, 1, kSeed + 10'000 + i);
      const Fit fit = infer(mugmwm(open, at, Weighting::kFull), at);
      seen[i] = fit.parameters[1][0].observability == Observability::kObserved ? 1 : 0;
    });
    double sum = 0.0;
    for (const int one : seen) sum += one;
    return sum / static_cast<double>(kRecordings);
  };
  const double before = seen_share(kShort);
  const double after = seen_share(length);
  const double twice = seen_share(2 * length);
  std::printf(
      "RW seen in %.0f %% at T = %zu; told %.2f times longer: %.0f %% there, %.0f %% at twice "
      "that; "
      "%zu of %zu recordings were told a length\n",
      100.0 * before, kShort, factor, 100.0 * after, 100.0 * twice, told.size(), kRecordings);
  EXPECT_LT(before, 0.3);
  EXPECT_GT(after, 0.5 - testing::binomial_allowance(0.5, kRecordings));
  EXPECT_GT(twice, after);
}

}  // namespace
}  // namespace imunoise
