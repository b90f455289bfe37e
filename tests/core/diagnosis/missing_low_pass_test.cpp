// White noise behind a low-pass filter: found with its kind, order and cut-off, and not found where
// simpler noise does as well.

#include "core/diagnosis/missing_low_pass.h"

#include <gtest/gtest.h>

#include "core/diagnosis/missing_noise.h"
#include "tests/core/diagnosis/subject_of.h"

namespace imunoise {
namespace {

constexpr std::size_t kFilteredLength = 32'768;

// The best of all noise that may be missing, fitted.
TriedTerm best_noise(const char* truth, const char* start, std::uint64_t seed) {
  const FittedModel plain =
      fitted(subject_of({.model = truth, .samples = kFilteredLength, .seed = seed}), start);
  const Current current = current_of(plain.regression, plain.fit);
  return try_all(current, search_noise(current)).front();
}

const Process& added(const TriedTerm& tried) {
  return std::get<NoiseChange>(tried.suggestion.added).added;
}

TEST(LowPass, IsFoundWithItsKindOrderAndCutoff) {
  const TriedTerm digital =
      best_noise("BUTTERWORTH(2, sigma2=1, omega=0.5) + RW(gamma2=1e-6)", "WN + RW", 71);
  EXPECT_EQ(digital.cause, "low_pass");
  ASSERT_TRUE(std::holds_alternative<DigitalFilter>(added(digital)));
  EXPECT_EQ(structure(added(digital)), 2);
  EXPECT_NEAR(values(added(digital))[1], 0.5, 0.01);
  const TriedTerm analog =
      best_noise("LOWPASS(4, sigma2=1, omega=1.5) + RW(gamma2=1e-6)", "WN + RW", 72);
  ASSERT_TRUE(std::holds_alternative<AnalogFilter>(added(analog)));
  EXPECT_EQ(structure(added(analog)), 4);
  EXPECT_NEAR(values(added(analog))[1], 1.5, 0.03);
}

// What the converter adds comes behind the filter.
TEST(LowPass, IsFoundBesideWhiteNoise) {
  const TriedTerm found =
      best_noise("BUTTERWORTH(2, sigma2=1, omega=0.3) + WN(sigma2=1e-3)", "WN", 73);
  ASSERT_TRUE(std::holds_alternative<DigitalFilter>(added(found)));
  EXPECT_NEAR(values(added(found))[1], 0.3, 0.01);
  EXPECT_EQ(found.fitted.fit.model.noise.terms.size(), 2U);
}

// A Markov process stood for the filter: it takes its place.
TEST(LowPass, TakesThePlaceOfFastNoise) {
  const TriedTerm found = best_noise("BUTTERWORTH(2, sigma2=1, omega=0.3)", "WN + AR1", 74);
  ASSERT_TRUE(std::holds_alternative<DigitalFilter>(added(found)));
  EXPECT_NEAR(values(added(found))[1], 0.3, 0.01);
}

// Far below the rate, a filter of second order is two lags in a row, as a resonance without a ring.
TEST(LowPass, IsNoResonanceHoweverLowItIs) {
  const TriedTerm found =
      best_noise("LOWPASS(2, sigma2=1, omega=0.03) + WN(sigma2=1e-5)", "WN", 76);
  EXPECT_EQ(found.cause, "low_pass");
  ASSERT_EQ(structure(added(found)), 2);
  EXPECT_NEAR(values(added(found))[1], 0.03, 0.002);
}

// Lags that are no Butterworth filter have a process of their own, and the same name.
TEST(LowPass, IsTheNameOfAnyFastLags) {
  for (const char* const truth :
       {"RES(sigma2=1, r=0.644, omega=0.668)", "AR2(sigma2=1, rho1=0.9286, phi2=-0.4)"}) {
    const TriedTerm found = best_noise(truth, "WN", 77);
    EXPECT_EQ(found.cause, "low_pass") << truth << ", seed 77";
    EXPECT_TRUE(found.could_be.empty()) << truth << ", seed 77";
  }
}

// Fast noise left no white noise; what is missing beside it is slow.
TEST(LowPass, IsNoSlowNoiseBesideIt) {
  const TriedTerm found =
      best_noise("AR1(sigma2=1, phi=0.5) + AR1(sigma2=1e-4, phi=0.999)", "AR1", 78);
  EXPECT_EQ(found.cause, "gauss_markov") << "seed 78";
}

TEST(LowPass, IsNotOfferedWhereSimplerNoiseDoes) {
  for (const char* const truth :
       {"AR1(sigma2=1, phi=0.6)", "WN(sigma2=1) + AR1(sigma2=0.3, phi=0.8)", "MAVG(4, sigma2=1)"}) {
    const FittedModel plain =
        fitted(subject_of({.model = truth, .samples = kFilteredLength, .seed = 75}), "WN");
    const Current current = current_of(plain.regression, plain.fit);
    for (const TriedTerm& one : try_all(current, search_noise(current))) {
      const bool filter = std::holds_alternative<AnalogFilter>(added(one)) ||
                          std::holds_alternative<DigitalFilter>(added(one));
      EXPECT_FALSE(filter && one.gain > 0.0) << truth << ", seed 75";
    }
  }
}

}  // namespace
}  // namespace imunoise
