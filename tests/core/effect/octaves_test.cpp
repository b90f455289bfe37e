// Coefficients of a coupling, one an octave.

#include <gtest/gtest.h>

#include <cmath>
#include <vector>

#include "core/process/process.h"
#include "tests/core/diagnosis/subject_of.h"

namespace imunoise {
namespace {

constexpr Hertz kBoardRate{50.0};
constexpr std::size_t kBoardSamples = 16'384;
constexpr std::uint32_t kBoards = 4;

// A sensor that feels a Markov process, beside another that does, with white noise of its own.
std::shared_ptr<const Subject> two_that_feel(std::uint64_t seed) {
  std::vector<std::vector<double>> own;
  NamedChannel other{"gyro_y", {}};
  std::vector<std::vector<double>> beside;
  const auto made = [&](const char* model, std::uint64_t more, std::uint32_t k) {
    return simulate(*parse_model(model, kBoardRate), kBoardSamples, seed + more, k);
  };
  for (std::uint32_t k = 0; k < kBoards; ++k) {
    const std::vector<double> shaking = made("AR1(phi=0.9, sigma2=0.04)", 0, k);
    own.push_back(made("WN(sigma2=1)", 1, k));
    beside.push_back(made("WN(sigma2=2)", 2, k));
    for (std::size_t t = 0; t < kBoardSamples; ++t) {
      own[k][t] += shaking[t];
      beside[k][t] += shaking[t];
    }
  }
  std::vector<Signal> replicates;
  for (std::uint32_t k = 0; k < kBoards; ++k) {
    replicates.emplace_back(std::span<const double>(own[k]), kBoardRate, Quantity::kAngularRate);
    other.replicates.emplace_back(std::span<const double>(beside[k]), kBoardRate,
                                  Quantity::kAngularRate);
  }
  return std::make_shared<const Subject>(make_subject(replicates, {other}));
}

// What both feel over all that the witness measures, each octave by itself (Wiener 1949): the
// coefficients lie within four standard errors of that.
TEST(Octaves, CoefficientsAreThoseOfTheBestFilter) {
  constexpr std::uint64_t kSeed = 7301;
  SCOPED_TRACE(kSeed);
  const FittedModel fit = fitted(two_that_feel(kSeed), "WN + AR1 + witness(gyro_y, octaves=5)");
  ASSERT_EQ(fit.regression.coefficients().size(), 5U);
  const Process shared = Ar1{0.04, 0.9};
  const auto mean = [&](double from, double to, const auto& of) {
    double sum = 0.0;
    constexpr int kPlaces = 200;
    for (int i = 0; i < kPlaces; ++i) sum += of(from + (to - from) * (i + 0.5) / kPlaces);
    return sum / kPlaces;
  };
  double from = 0.0;
  for (Eigen::Index i = 0; i < 5; ++i) {
    const double to = 0.5 * std::exp2(static_cast<double>(i) - 4.0);  // cycles per sample
    const auto noise = [&](double f) {
      double sum = 0.0;
      for (const Term& term : fit.fit.model.noise.terms) sum += spectrum(term.process, f);
      return sum;
    };
    const double common = mean(from, to, [&](double f) { return spectrum(shared, f) / noise(f); });
    const double all =
        mean(from, to, [&](double f) { return (spectrum(shared, f) + 2.0) / noise(f); });
    const double error = std::sqrt(fit.fit.effects.covariance(i, i));
    EXPECT_NEAR(fit.fit.effects.value(i), common / all, 4.0 * error) << "octave " << i + 1;
    from = to;
  }
  // Not one coefficient for all.
  EXPECT_GT(fit.fit.effects.value(0), 2.0 * fit.fit.effects.value(4));
}

TEST(Octaves, ExplainMoreThanOneBand) {
  constexpr std::uint64_t kSeed = 7302;
  SCOPED_TRACE(kSeed);
  const auto subject = two_that_feel(kSeed);
  const auto likelihood = [&](const char* model) {
    return fitted(subject, model).fit.log_likelihood;
  };
  const double best_band = std::max({likelihood("WN + AR1 + witness(gyro_y)"),
                                     likelihood("WN + AR1 + witness(gyro_y, to=1.5625)"),
                                     likelihood("WN + AR1 + witness(gyro_y, to=3.125)"),
                                     likelihood("WN + AR1 + witness(gyro_y, to=6.25)")});
  // Three coefficients more gain three nats once in 20.
  EXPECT_GT(likelihood("WN + AR1 + witness(gyro_y, to=12.5, octaves=4)"), best_band + 6.0);
}

}  // namespace
}  // namespace imunoise
