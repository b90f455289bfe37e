// The generator against itself: what it says of its strengths holds for what it makes.

#include <gtest/gtest.h>

#include <cmath>
#include <numbers>
#include <numeric>

#include "tests/hidden_effects/generator/cosine.h"
#include "tests/hidden_effects/generator/hidden_case.h"
#include "tests/hidden_effects/generator/oracle.h"
#include "tests/hidden_effects/generator/two_level_oracle.h"

namespace imunoise::hidden {
namespace {

TEST(CosineCoefficients, AreTheSumsOfTheirDefinition) {
  RandomStream random(20261122);
  Series x(64);
  for (double& value : x) value = random.normal();
  const Series got = cosine_coefficients(x);
  const double n = static_cast<double>(x.size());
  for (std::size_t k = 0; k < x.size(); ++k) {
    double sum = 0.0;
    for (std::size_t t = 0; t < x.size(); ++t) {
      sum += x[t] * std::cos(std::numbers::pi * static_cast<double>(k) *
                             (static_cast<double>(t) + 0.5) / n);
    }
    EXPECT_NEAR(got[k], sum * std::sqrt((k == 0 ? 1.0 : 2.0) / n), 1e-12) << k;
  }
}

// Mean of X²/S over coefficients (in eight bands of equal numbers) and over 64 series of 1024
// samples: 8192 values a band, standard deviation √(2/8192) = 0.0156; 5 of them.
void expect_spectrum(const BaseNoise& law, const char* what) {
  constexpr std::size_t kSamples = 1024;
  const Series expected = law.spectrum(kSamples);
  Series ratio(8, 0.0);
  for (std::uint32_t i = 0; i < 64; ++i) {
    RandomStream random(20261122, {i});
    const Series got = cosine_coefficients(law.simulate(random, kSamples));
    for (std::size_t k = 1; k < kSamples; ++k) {
      ratio[k / 128] += got[k] * got[k] / expected[k - 1] / (64.0 * (k < 128 ? 127.0 : 128.0));
    }
  }
  for (std::size_t band = 0; band < 8; ++band) {
    EXPECT_NEAR(ratio[band], 1.0, 0.08) << what << ", band " << band;
  }
}

TEST(BaseNoise, HasTheSpectrumThatItSays) {
  BaseNoise walk;
  walk.white = 1.0;
  walk.walk = 0.3;
  expect_spectrum(walk, "white noise and a random walk");
  BaseNoise markov;
  markov.markov = {{1.0, 3.0}};
  markov.white = 0.3;
  expect_spectrum(markov, "Markov noise");
  BaseNoise ringing;
  ringing.ringing = {{1.0, 0.9, 1.2}};
  ringing.white = 0.3;
  expect_spectrum(ringing, "a resonance");
  BaseNoise flicker;
  flicker.markov = octaves_of_flicker(0.2, 1024);
  expect_spectrum(flicker, "flicker");
}

// level²/f between a hundredth of a cycle a sample and a hundred times the length of a recording.
TEST(BaseNoise, FlickerIsOneOverF) {
  constexpr std::size_t kSamples = 1U << 15U;
  BaseNoise law;
  law.markov = octaves_of_flicker(0.1, kSamples);
  const Series got = law.spectrum(kSamples);
  for (std::size_t k = 1; k < kSamples / 50; k *= 2) {
    const double f = 0.5 * static_cast<double>(k) / kSamples;
    EXPECT_NEAR(got[k - 1] * f / 0.01, 1.0, 0.03) << "at " << f << " cycles per sample";
  }
}

// The same of other slopes: flat ones end sooner at the short end, steep ones at the long end.
TEST(BaseNoise, OctavesMakeAnyPowerLaw) {
  constexpr std::size_t kSamples = 1U << 15U;
  for (const double slope : {-0.5, -1.5}) {
    BaseNoise law;
    law.markov = octaves_of_power_law(slope, 0.1, kSamples);
    const Series got = law.spectrum(kSamples);
    for (std::size_t k = 16; k < kSamples / 500; k *= 2) {
      const double f = 0.5 * static_cast<double>(k) / kSamples;
      EXPECT_NEAR(got[k - 1] / (0.01 * std::pow(f, slope)), 1.0, 0.06) << slope << " at " << f;
    }
  }
}

// Haar wavelet variance at half-width m: σ²/2m + γ²(4m² + 2)/24m for white noise and a walk.
TEST(BaseNoise, HasTheWaveletVarianceOfItsLaw) {
  constexpr std::size_t kSamples = 1U << 18U;
  BaseNoise law;
  law.white = 1.0;
  law.walk = 0.05;
  RandomStream random(20261122);
  const Series x = law.simulate(random, kSamples);
  for (const std::size_t m : {1U, 4U, 16U, 64U}) {
    double sum = 0.0;
    std::size_t count = 0;
    for (std::size_t t = 0; t + 2 * m <= kSamples; ++t, ++count) {
      const auto at = x.begin() + static_cast<std::ptrdiff_t>(t);
      const auto half = static_cast<std::ptrdiff_t>(m);
      const double w =
          std::accumulate(at + half, at + 2 * half, 0.0) - std::accumulate(at, at + half, 0.0);
      sum += w * w / static_cast<double>(4 * m * m);
    }
    const double width = static_cast<double>(m);
    const double expected =
        1.0 / (2.0 * width) + 0.0025 * (4.0 * width * width + 2.0) / (24.0 * width);
    // Relative deviation below √(6m/n) for either; four of them.
    EXPECT_NEAR(sum / static_cast<double>(count) / expected, 1.0,
                4.0 * std::sqrt(6.0 * width / kSamples))
        << m;
  }
}

CaseSpec small_case(const char* effect, double delta, std::uint64_t seed) {
  CaseSpec spec;
  spec.effects = {effect};
  spec.delta = delta;
  spec.seed = seed;
  spec.replicates = 2;
  spec.samples = 1U << 10U;
  return spec;
}

struct Moments {
  double mean = 0.0;
  double deviation = 0.0;
};

Moments moments(const Series& values) {
  Moments out;
  const double n = static_cast<double>(values.size());
  for (const double x : values) out.mean += x / n;
  for (const double x : values) out.deviation += (x - out.mean) * (x - out.mean) / (n - 1.0);
  out.deviation = std::sqrt(out.deviation);
  return out;
}

// All 2¹² courses of twelve samples, each less its levels a walk in white noise. 300 repeats of 200
// particles: the mean likelihood is right for any number of them (Del Moral 1996).
TEST(TwoLevelOracle, SumsOverAllCourses) {
  constexpr std::size_t kSamples = 12;
  const WhiteWalk noise{1.0, 0.3};
  const TwoLevelLaw law{3.0, 4.0};
  RandomStream random(20261125);
  Series x(kSamples);
  for (std::size_t t = 0; t < kSamples; ++t) x[t] = random.normal() + (t < 5 ? 1.5 : -1.5);
  double exact = 0.0;
  for (unsigned course = 0; course < 1U << kSamples; ++course) {
    Series left = x;
    double probability = 0.5;
    for (std::size_t t = 0; t < kSamples; ++t) {
      const bool jumps = t > 0 && ((course >> t ^ course >> (t - 1)) & 1U) != 0;
      left[t] -= (course >> t & 1U) != 0 ? 1.5 : -1.5;
      if (t > 0) probability *= jumps ? 0.25 : 0.75;
    }
    exact += probability * std::exp(log_likelihood(left, noise));
  }
  Series likelihoods;
  for (int repeat = 0; repeat < 300; ++repeat)
    likelihoods.push_back(std::exp(log_likelihood(x, noise, law, random, 200)) / exact);
  const Moments at = moments(likelihoods);
  EXPECT_NEAR(at.mean, 1.0, 5.0 * at.deviation / std::sqrt(300.0));
}

// Scenes of a case are the same before the effect is hidden, so its clean recordings are the
// absence and its recordings the presence of one and the same effect. The oracle's ratio of a shift
// h is hᵀΣ⁻¹x - ½hᵀΣ⁻¹h; the sets differ in their laws, but δ is the same in all.
void expect_shift(const char* effect) {
  constexpr double kDelta = 4.0;
  constexpr std::uint64_t kSets = 200;
  Series absent;
  Series present;
  for (std::uint64_t seed = 1; seed <= kSets; ++seed) {
    const HiddenCase made = make_case(small_case(effect, kDelta, seed));
    const Series spectrum = made.base.spectrum(made.spec.samples);
    double without = 0.0;
    double with = 0.0;
    for (std::size_t r = 0; r < made.recordings.size(); ++r) {
      const Series x0 = cosine_coefficients(made.clean[r][kSubject]);
      const Series x1 = cosine_coefficients(made.recordings[r][kSubject]);
      for (std::size_t k = 1; k < x0.size(); ++k) {
        const double h = x1[k] - x0[k];
        without += (h * x0[k] - 0.5 * h * h) / spectrum[k - 1];
        with += (h * x1[k] - 0.5 * h * h) / spectrum[k - 1];
      }
    }
    absent.push_back(without);
    present.push_back(with);
  }
  const Moments at0 = moments(absent);
  const Moments at1 = moments(present);
  // The deviation of 200 sets is known to 1/√400 = 5 %; four of them.
  EXPECT_NEAR((at1.mean - at0.mean) / at0.deviation, kDelta, 0.2 * kDelta) << effect;
  EXPECT_NEAR(at0.mean, -0.5 * kDelta * kDelta, 4.0 * kDelta / std::sqrt(200.0)) << effect;
}

TEST(Strength, OfAShiftIsItsDeflection) {
  expect_shift("line");
  expect_shift("temperature/lagged");
  expect_shift("warm_up");
}

double ratio(const Recording& recording, const Series& s0, const Series& s1) {
  const Series x = cosine_coefficients(recording[kSubject]);
  double sum = 0.0;
  for (std::size_t k = 1; k < x.size(); ++k) {
    sum +=
        0.5 * (std::log(s0[k - 1] / s1[k - 1]) + x[k] * x[k] * (1.0 / s0[k - 1] - 1.0 / s1[k - 1]));
  }
  return sum;
}

// E1 of Σ ½[ln(S0/S1) + X²(1/S0 - 1/S1)] is half the square of the informed δ, whose deflection is
// near it for a faint change; against the nearest base it is δ²/2.
void expect_change(const char* effect, Series (*after)(const HiddenCase&)) {
  constexpr double kDelta = 4.0;
  constexpr std::uint64_t kSets = 200;
  Series absent;
  Series present;
  Series identified;
  double informed = 0.0;
  for (std::uint64_t seed = 1; seed <= kSets; ++seed) {
    const HiddenCase made = make_case(small_case(effect, kDelta, seed));
    const Injection& put = made.injections.front();
    EXPECT_NEAR(put.delta, kDelta, 1e-3);
    const Series s0 = made.base.spectrum(made.spec.samples);
    const Series s1 = after(made);
    const Series nearest = nearest_sum(s1, made.base.parts(made.spec.samples));
    double sums[3] = {};
    for (std::size_t r = 0; r < made.recordings.size(); ++r) {
      sums[0] += ratio(made.clean[r], s0, s1);
      sums[1] += ratio(made.recordings[r], s0, s1);
      sums[2] += ratio(made.recordings[r], nearest, s1);
    }
    absent.push_back(sums[0] / put.informed);
    present.push_back(sums[1] / put.informed);
    identified.push_back(sums[2]);
    informed += put.informed / static_cast<double>(kSets);
  }
  const Moments at0 = moments(absent);
  const Moments at1 = moments(present);
  const Moments at = moments(identified);
  // Ratios over the informed δ, which differs between sets: means of ±δ/2, deviations near 1.
  EXPECT_NEAR((at1.mean - at0.mean) / std::sqrt(at0.deviation * at1.deviation) / informed, 1.0, 0.2)
      << effect;
  EXPECT_NEAR(at1.mean, 0.5 * informed, 5.0 * at1.deviation / std::sqrt(200.0)) << effect;
  EXPECT_NEAR(at.mean, 0.5 * kDelta * kDelta, 5.0 * at.deviation / std::sqrt(200.0)) << effect;
}

Series after_angle_rounding(const HiddenCase& made) {
  const double q2 = made.injections.front().parameters.front().value;
  Series out = made.base.spectrum(made.spec.samples);
  for (std::size_t k = 0; k < out.size(); ++k) {
    const double s = std::sin(0.5 * std::numbers::pi * static_cast<double>(k + 1) /
                              static_cast<double>(made.spec.samples));
    out[k] += 4.0 * q2 * s * s;
  }
  return out;
}

Series after_low_pass(const HiddenCase& made) {
  const double tau = made.injections.front().parameters.front().value * made.rate_hz;
  const double pole = std::exp(-1.0 / tau);
  Series out = made.base.spectrum(made.spec.samples);
  for (std::size_t k = 0; k < out.size(); ++k) {
    const double omega =
        std::numbers::pi * static_cast<double>(k + 1) / static_cast<double>(made.spec.samples);
    out[k] *= (1.0 - pole) * (1.0 - pole) / (1.0 - 2.0 * pole * std::cos(omega) + pole * pole);
  }
  return out;
}

TEST(Strength, OfASpectrumIsTheOraclesMeanRatio) {
  expect_change("quantisation/angle", after_angle_rounding);
  expect_change("low_pass", after_low_pass);
}

TEST(Strength, OfOutliersIsTheMeanRatioOfASample) {
  constexpr double kShare = 0.01;
  constexpr double kFactor = 4.0;
  constexpr int kSamples = 1 << 20;
  RandomStream random(20261122);
  double sum = 0.0;
  double squares = 0.0;
  for (int i = 0; i < kSamples; ++i) {
    const bool odd = static_cast<double>(random.engine()() >> 11U) * 0x1p-53 < kShare;
    const double x = random.normal() * (odd ? std::sqrt(1.0 + kFactor * kFactor) : 1.0);
    const double v = 1.0 + kFactor * kFactor;
    const double ratio =
        std::log(1.0 - kShare + kShare / std::sqrt(v) * std::exp(0.5 * x * x * (1.0 - 1.0 / v)));
    // Against the normal law of the same variance.
    const double same = 1.0 + kShare * kFactor * kFactor;
    const double beyond = ratio + 0.5 * std::log(same) - 0.5 * x * x * (1.0 - 1.0 / same);
    sum += beyond;
    squares += beyond * beyond;
  }
  const double mean = sum / kSamples;
  const double error = std::sqrt((squares / kSamples - mean * mean) / kSamples);
  EXPECT_NEAR(outlier_divergence(kShare, kFactor), mean, 5.0 * error);
}

// What single sets gain scatters about ½δ², for δ = 6 by about 6 nats, and more where the power of
// the one replicate is not what the other one tells.
TEST(Strength, OfAChangedPowerIsTheMeanOfWhatTheDataGain) {
  constexpr double kDelta = 6.0;
  constexpr std::uint64_t kSets = 100;
  Series beyond;
  for (std::uint64_t seed = 1; seed <= kSets; ++seed) {
    const HiddenCase made = make_case(small_case("power_change", kDelta, seed));
    const Injection& put = made.injections.front();
    const double growth = put.parameters.at(0).value;
    const double changed = (put.parameters.at(2).value - put.parameters.at(1).value) * made.rate_hz;
    const auto n = static_cast<double>(made.spec.samples);
    const double power = 1.0 + growth * changed / n;  // of that replicate
    const double told = 0.5 * n * (power + std::log(power) + 1.0 / power);
    const double known = n * (std::log(0.5 * (power + 1.0)) + 1.0);
    beyond.push_back(put.gained.value() - 0.5 * kDelta * kDelta - (told - known));
  }
  const Moments at = moments(beyond);
  EXPECT_NEAR(at.mean, 0.0, 4.0 * at.deviation / std::sqrt(static_cast<double>(kSets)));
}

// The likelihood ratio summed over phases one by one.
TEST(Strength, OfAWaveFallsByWhatItsPhaseCosts) {
  constexpr int kPhases = 64;
  constexpr int kSets = 20000;
  for (const double delta : {0.5, 2.0, 6.0}) {
    RandomStream random(20261127);
    double sum = 0.0;
    double squares = 0.0;
    for (int i = 0; i < kSets; ++i) {
      const double x = delta + random.normal();
      const double y = random.normal();
      double untold = 0.0;
      for (int p = 0; p < kPhases; ++p) {
        const double phase = 2.0 * std::numbers::pi * p / kPhases;
        untold += std::exp(delta * (x * std::cos(phase) + y * std::sin(phase))) / kPhases;
      }
      const double price = delta * x - std::log(untold);
      sum += price;
      squares += price * price;
    }
    const double mean = sum / kSets;
    const double error = std::sqrt((squares / kSets - mean * mean) / kSets);
    EXPECT_NEAR(phase_price(delta), mean, 4.0 * error) << delta;
  }
  constexpr double kLarge = 40.0;
  EXPECT_NEAR(phase_price(kLarge), 0.5 * std::log(2.0 * std::numbers::pi * kLarge * kLarge) - 0.5,
              1e-3);
}

// KL of Student's t of 4 degrees of freedom and unit variance from the normal law: the difference
// of their entropies, ½ ln(2πe) - (5/2)(ψ(5/2) - ψ(2)) - ln(√2·B(2, ½)); ψ(5/2) = 8/3 - γ - 2 ln 2,
// ψ(2) = 1 - γ, B(2, ½) = 4/3.
TEST(Strength, OfStudentsTailsIsTheDifferenceOfEntropies) {
  Series weights;
  Series variances;
  constexpr double kStep = 0.02;
  for (double u = -9.0; u < 4.5; u += kStep) {
    const double chi2 = std::exp(u);
    weights.push_back(kStep * 0.25 * chi2 * chi2 * std::exp(-0.5 * chi2));
    variances.push_back(2.0 / chi2);
  }
  const double entropy =
      2.5 * (5.0 / 3.0 - 2.0 * std::numbers::ln2) + std::log(std::numbers::sqrt2 * 4.0 / 3.0);
  const double normal = 0.5 * std::log(2.0 * std::numbers::pi * std::numbers::e);
  EXPECT_NEAR(mixture_divergence(weights, variances), normal - entropy, 1e-4);
}

TEST(Strength, WhatTheBaseCanFollowIsNoEffect) {
  BaseNoise law;
  law.white = 1.0;
  law.walk = 0.02;
  const std::vector<Series> parts = law.parts(4096);
  Series louder = law.spectrum(4096);
  for (double& s : louder) s *= 1.5;
  EXPECT_LT(divergence(nearest_sum(louder, parts), louder), 0.01);
  EXPECT_GT(divergence(law.spectrum(4096), louder), 100.0);
}

TEST(HiddenCase, EveryEffectReachesItsStrengthAndTouchesTheSubject) {
  for (const HiddenEffect& effect : hidden_effects()) {
    CaseSpec spec = small_case("", 6.0, 3);
    spec.effects = {effect.name()};
    const HiddenCase made = make_case(spec);
    ASSERT_EQ(made.injections.size(), 1U);
    // So few samples cannot show tails as faint as those of t8 any better.
    const bool counted = effect.id == "outliers" || effect.name() == "heavy_tails/t8";
    EXPECT_NEAR(made.injections[0].delta, 6.0, counted ? 3.0 : 1e-3) << effect.name();
    EXPECT_GE(made.injections[0].informed, made.injections[0].delta - 0.01) << effect.name();
    bool changed = false;
    for (std::size_t r = 0; r < made.recordings.size(); ++r) {
      for (const double x : made.recordings[r][kSubject]) ASSERT_TRUE(std::isfinite(x));
      changed = changed || made.recordings[r][kSubject] != made.clean[r][kSubject];
    }
    EXPECT_TRUE(changed) << effect.name();
  }
}

TEST(HiddenCase, TheSameSpecMakesTheSameCase) {
  const HiddenCase a = make_case(small_case("line", 8.0, 5));
  const HiddenCase b = make_case(small_case("line", 8.0, 5));
  const HiddenCase c = make_case(small_case("line", 8.0, 6));
  EXPECT_EQ(a.recordings[1][kSubject], b.recordings[1][kSubject]);
  EXPECT_NE(a.recordings[1][kSubject], c.recordings[1][kSubject]);
}

TEST(HiddenCase, AWithheldWitnessIsNotInTheFile) {
  CaseSpec spec = small_case("temperature/static", 8.0, 5);
  spec.withhold = true;
  const HiddenCase made = make_case(spec);
  for (const Trace& trace : made.recordings.front().traces) EXPECT_NE(trace.name, "temperature");
}

}  // namespace
}  // namespace imunoise::hidden
