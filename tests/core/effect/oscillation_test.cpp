// Tones of constant amplitude and unsteady frequency: found, told apart from noise that rings, and
// turned into normal numbers by a filter whose density is right.

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <numbers>

#include "core/diagnosis/candidates.h"
#include "core/effect/columns.h"
#include "core/effects/distributions/wandering_tone.h"
#include "core/effects/known_effects.h"
#include "core/search/noise_bump.h"
#include "core/search/search_view.h"
#include "core/support/random.h"
#include "tests/core/diagnosis/subject_of.h"
#include "tests/support/figures_alone.h"

namespace imunoise {
namespace {

using Index = Eigen::Index;
using Occupancy = WanderingTone::Occupancy;

constexpr double kTurn = 2.0 * std::numbers::pi;

Diagnosis diagnosis_with(const std::string& effect, std::uint64_t seed) {
  const auto model = parse_full_model("WN + " + effect, Hertz{50.0});
  const auto plain = subject_of({.seed = seed});
  return diagnose(fitted(with_effects(*plain, model->effects, seed)));
}

TEST(Oscillation, IsFoundAndTakenOut) {
  const Diagnosis diagnosis = diagnosis_with("oscillation(from=6, to=10, amplitude=1.2)", 51);
  ASSERT_FALSE(diagnosis.effects.empty());
  const RankedTerm& best = diagnosis.effects[0];
  EXPECT_EQ(best.tried.cause, "oscillation");
  // No other sensor says whether the bench moves.
  EXPECT_EQ(diagnosis.verdict, DiagnosisVerdict::kOneOf);
  EXPECT_EQ(best.confused_with, (std::vector<std::string>{"g_sensitivity", "common_vibration"}));
  const std::vector<ReportedNumber> numbers = fitted_numbers({best.tried.fitted, 0});
  ASSERT_EQ(numbers[0].name, "amplitude");
  ASSERT_TRUE(numbers[0].lower && numbers[0].upper);
  const double error = 0.5 * (*numbers[0].upper - *numbers[0].lower) / interval_reach();
  EXPECT_NEAR(numbers[0].value, 1.2, 3.9 * error);
  ASSERT_EQ(numbers[1].name, "mean_frequency_hz");
  EXPECT_NEAR(numbers[1].value, 8.0, 0.2);
}

// A frequency that roams over two fifths of all: its skirts lie outside what stands out.
TEST(Oscillation, AWideOneKeepsItsAmplitude) {
  FIGURES_ALONE();
  for (std::uint64_t seed = 53; seed < 56; ++seed) {
    const auto model =
        parse_full_model("WN + oscillation(from=3, to=22, amplitude=2)", Hertz{50.0});
    const auto plain = subject_of({.seed = seed});
    const FittedModel fit = fitted(with_effects(*plain, model->effects, seed));
    const Current current = current_of(fit.regression, fit.fit);
    const std::vector<TriedTerm> tried =
        try_all(current, effect_named("oscillation").search(SearchView(current)));
    ASSERT_EQ(tried.size(), 1U) << seed;
    const ReportedNumber amplitude = fitted_numbers({tried[0].fitted, 0}).front();
    ASSERT_TRUE(amplitude.lower) << seed;
    const double error = 0.5 * (*amplitude.upper - *amplitude.lower) / interval_reach();
    EXPECT_NEAR(amplitude.value, 2.0, 3.9 * error) << seed;
  }
}

// Eight recordings without a tone: noise seems one in more than 2 of them with a chance of 0.6 %.
TEST(Oscillation, WhereThereIsNoneItsAmplitudeIsBounded) {
  FIGURES_ALONE();
  int seen = 0;
  for (std::uint64_t seed = 400; seed < 408; ++seed) {
    const FittedModel fit = fitted(subject_of({.samples = 4096, .replicates = 2, .seed = seed}),
                                   "WN + RW + oscillation(from=6, to=12)");
    const std::vector<ReportedNumber> numbers = fitted_numbers({fit, 0});
    if (numbers.size() > 1) {
      ++seen;
      continue;
    }
    EXPECT_EQ(numbers[0].value, 0.0);
    EXPECT_EQ(numbers[0].lower, 0.0);
    ASSERT_TRUE(numbers[0].upper);
    EXPECT_GT(*numbers[0].upper, 0.02);
    EXPECT_LT(*numbers[0].upper, 0.5);
  }
  EXPECT_LE(seen, 2);
}

TEST(Oscillation, ABandTooNarrowForTheReplicatesIsRefused) {
  const auto subject = subject_of({.seed = 57});
  const EffectTerm narrow(effect_named("oscillation"), "", {{"from", 7.0}, {"to", 7.01}});
  const Result<void> refused = check(narrow, *subject);
  ASSERT_FALSE(refused);
  EXPECT_NE(refused.error().message.find("0.0488 Hz apart"), std::string::npos)
      << refused.error().message;
  EXPECT_TRUE(
      check(EffectTerm(effect_named("oscillation"), "", {{"from", 7.0}, {"to", 7.1}}), *subject));
}

// Another gyroscope shows the same tone a quarter of a wave late: the bench may vibrate.
TEST(Oscillation, AnotherSensorMayShowIt) {
  double phase = 0.0;
  std::vector<double> tone;
  RandomStream random(58);
  for (std::size_t t = 0; t < 4 * 8192 + 2; ++t) {
    tone.push_back(phase);
    phase += kTurn * (0.16 + 0.02 * random.normal());
  }
  const auto place = [](std::size_t k, double s) {
    return 8192 * k + static_cast<std::size_t>(std::lround(s * 50.0));
  };
  for (const bool there : {true, false}) {
    RandomStream noise(59);
    const auto subject =
        subject_of({.seed = 58,
                    .added = [&](std::size_t k, double s) { return std::cos(tone[place(k, s)]); },
                    .temperature =
                        [&](std::size_t k, double s) {
                          return noise.normal() + (there ? 0.3 * std::sin(tone[place(k, s)]) : 0.0);
                        },
                    .witness = Quantity::kAngularRate});
    const FittedModel fit = fitted(subject);
    const Current current = current_of(fit.regression, fit.fit);
    const std::vector<TriedTerm> tried =
        try_all(current, effect_named("oscillation").search(SearchView(current)));
    ASSERT_EQ(tried.size(), 1U);
    const auto& could = tried[0].could_be;
    EXPECT_EQ(std::find(could.begin(), could.end(), "common_vibration") != could.end(), there);
  }
}

// A tone that keeps its frequency for long, and drifts over minutes, may be that of a fan; one that
// changes within some turns is none.
TEST(Oscillation, ADriftingToneMayBeAMachine) {
  for (const bool drifts : {true, false}) {
    RandomStream random(61);
    std::vector<double> phase{0.0};
    for (int t = 0; t < 4 * 8192 + 2; ++t) {
      const double away = drifts ? 0.004 * std::sin(kTurn * t / 5000.0) : 0.02 * random.normal();
      phase.push_back(phase.back() + kTurn * (0.16 + away));
    }
    const auto subject = subject_of(
        {.seed = 61, .added = [&](std::size_t k, double s) {
           return 1.2 * std::cos(phase[8192 * k + static_cast<std::size_t>(std::lround(s * 50.0))]);
         }});
    const FittedModel fit = fitted(subject);
    const Current current = current_of(fit.regression, fit.fit);
    const std::vector<TriedTerm> tried =
        try_all(current, effect_named("oscillation").search(SearchView(current)));
    ASSERT_EQ(tried.size(), 1U) << drifts;
    const auto& could = tried[0].could_be;
    EXPECT_EQ(std::find(could.begin(), could.end(), "wandering_line") != could.end(), drifts);
  }
}

// A resonance at the same place is never called an oscillation: ten seeds.
TEST(Oscillation, NoiseThatRingsIsNone) {
  FIGURES_ALONE();
  for (std::uint64_t seed = 200; seed < 210; ++seed) {
    const Diagnosis diagnosis = diagnose(fitted(
        subject_of({.model = "WN(sigma2=1) + RW(gamma2=1e-5) + RES(sigma2=0.05, r=0.95, omega=1)",
                    .seed = seed})));
    ASSERT_FALSE(diagnosis.effects.empty());
    EXPECT_EQ(diagnosis.effects[0].tried.cause, "resonance") << seed;
    for (const RankedTerm& one : diagnosis.effects)
      EXPECT_NE(one.tried.cause, "oscillation") << seed << ": " << one.tried.gain;
  }
}

// Too faint to show whether its amplitude is constant, it is at most "one of".
TEST(Oscillation, FaintOnesMayBeResonances) {
  const Diagnosis diagnosis = diagnosis_with("oscillation(from=6, to=10, amplitude=0.4)", 52);
  ASSERT_FALSE(diagnosis.effects.empty());
  const RankedTerm& best = diagnosis.effects[0];
  EXPECT_EQ(best.tried.cause, "resonance");
  EXPECT_EQ(diagnosis.verdict, DiagnosisVerdict::kOneOf);
  EXPECT_NE(std::find(best.confused_with.begin(), best.confused_with.end(), "oscillation"),
            best.confused_with.end());
}

// A tone as the filter says it is: its frequency moves between the places of the band.
Eigen::VectorXd tone_in_noise(const WanderingTone& tone, Index samples, std::uint64_t seed) {
  RandomStream random(seed);
  Eigen::VectorXd out(samples);
  Index place = WanderingTone::kPlaces / 2;
  double phase = 0.0;
  const auto uniform = [&] { return 0.5 * std::erfc(random.normal() / std::numbers::sqrt2); };
  for (double& x : out) {
    x = tone.amplitude * std::cos(phase) + random.normal();
    const double chance = uniform();
    if (chance < tone.pace && place + 1 < WanderingTone::kPlaces) {
      ++place;
    } else if (chance > 1.0 - tone.pace && place > 0) {
      --place;
    }
    phase += kTurn * tone.frequency(place) + std::sqrt(tone.diffusion) * random.normal();
  }
  return out;
}

const WanderingTone kTone{
    .from = 0.15, .to = 0.3, .amplitude = 1.0, .diffusion = 0.03, .pace = 0.02};

Occupancy even() { return Occupancy::Constant(1.0 / WanderingTone::kPlaces); }

// Kurtosis and lag products of 2¹⁷ normal numbers, each within 3.9 standard errors.
TEST(ToneFilter, MakesTheSamplesWhiteNoise) {
  constexpr Index kSamples = 1 << 17;
  Eigen::VectorXd normal;
  const Eigen::VectorXd samples = tone_in_noise(kTone, kSamples, 61);
  const ToneFilter::Passed passed = ToneFilter(kTone, even()).pass(samples, normal);
  EXPECT_GT(passed.nats, 0.02 * kSamples);
  const double error = 3.9 / std::sqrt(static_cast<double>(kSamples));
  const double mean_square = normal.squaredNorm() / kSamples;
  EXPECT_NEAR(normal.mean(), 0.0, error);
  EXPECT_NEAR(mean_square, 1.0, std::sqrt(2.0) * error);
  EXPECT_NEAR(normal.array().square().square().mean() / (mean_square * mean_square), 3.0,
              std::sqrt(24.0) * error);
  for (Index lag = 1; lag <= 12; ++lag) {
    const Index left = kSamples - lag;
    EXPECT_NEAR(normal.head(left).dot(normal.tail(left)) / kSamples, 0.0, error) << lag;
  }
  // The tone itself is not white.
  EXPECT_GT(std::abs(samples.head(kSamples - 2).dot(samples.tail(kSamples - 2)) / kSamples),
            10.0 * error);
}

// The nats are the density of the samples: the slope of each normal number by its sample, times the
// density of the number.
TEST(ToneFilter, CountsTheDensityOfItsNumbers) {
  constexpr Index kSamples = 40;
  constexpr double kStep = 1e-3;
  const Eigen::VectorXd samples = tone_in_noise(kTone, kSamples, 62);
  const ToneFilter filter(kTone, even());
  Eigen::VectorXd normal;
  const double nats = filter.pass(samples, normal).nats;
  double expected = 0.0;
  for (Index t = 0; t < kSamples; ++t) {
    Eigen::VectorXd moved[2];
    for (int side : {0, 1}) {
      Eigen::VectorXd other = samples;
      other(t) += side == 0 ? -kStep : kStep;
      filter.pass(other, moved[side]);
    }
    expected += std::log((moved[1](t) - moved[0](t)) / (2.0 * kStep)) +
                0.5 * (samples(t) * samples(t) - normal(t) * normal(t));
  }
  EXPECT_NEAR(nats, expected, 1e-3);
}

TEST(ToneFilter, FindsTheTone) {
  const std::vector<ToneSeries> series{{tone_in_noise(kTone, 1 << 15, 63), 1.0},
                                       {tone_in_noise(kTone, 1 << 15, 64), 1.0}};
  const FittedTone found = fit_tone(kTone.from, kTone.to, series);
  EXPECT_NEAR(found.tone.amplitude, kTone.amplitude, 3.9 * found.amplitude_error);
  EXPECT_LT(found.amplitude_error, 0.02);
  EXPECT_GT(found.tone.diffusion, 0.5 * kTone.diffusion);
  EXPECT_LT(found.tone.diffusion, 2.0 * kTone.diffusion);
  EXPECT_GT(found.tone.pace, 0.3 * kTone.pace);
  EXPECT_LT(found.tone.pace, 3.0 * kTone.pace);
}

// Samples far outside leave it on its feet.
TEST(ToneFilter, SurvivesOutliers) {
  Eigen::VectorXd samples = tone_in_noise(kTone, 2000, 65);
  samples(1000) = 1e6;
  samples(1001) = -300.0;
  Eigen::VectorXd normal;
  const ToneFilter::Passed passed = ToneFilter(kTone, even()).pass(samples, normal);
  EXPECT_TRUE(std::isfinite(passed.nats));
  EXPECT_TRUE(normal.allFinite());
  EXPECT_LT(normal.tail(900).squaredNorm() / 900.0, 1.3);
}

TEST(NoiseBump, LiesWhereTheResonanceIs) {
  const FittedModel plain = fitted(subject_of(
      {.model = "WN(sigma2=1) + RW(gamma2=1e-5) + RES(sigma2=0.05, r=0.95, omega=1)", .seed = 71}));
  const Current current = current_of(plain.regression, plain.fit);
  const auto bump = highest_bump(current);
  ASSERT_TRUE(bump);
  EXPECT_LT(bump->from, 1.0 / kTurn);
  EXPECT_GT(bump->to, 1.0 / kTurn);
  EXPECT_GT(bump->from, 0.05);
  EXPECT_LT(bump->to, 0.3);
  // Beside it is white noise, of power 1, and up to a fifth of the resonance at its edges. 128
  // coefficients on each side tell it to 9 %: 0.35 is 3.9 times that.
  const Eigen::ArrayXd beside = spectrum_beside(current, *bump, 0);
  EXPECT_GT(beside(beside.size() / 3), 1.0 - 0.35);
  EXPECT_LT(beside(beside.size() / 3), 1.2 + 0.35);
  const BumpTails tails = tails_of(current, *bump);
  EXPECT_LT(std::abs(tails.excess), 3.9 * tails.error);
  EXPECT_FALSE(may_be_tone(current));
}

TEST(NoiseBump, PlainNoiseHasNone) {
  for (std::uint64_t seed = 300; seed < 340; ++seed) {
    const FittedModel plain = fitted(subject_of({.seed = seed}));
    EXPECT_FALSE(highest_bump(current_of(plain.regression, plain.fit))) << seed;
  }
}

}  // namespace
}  // namespace imunoise
