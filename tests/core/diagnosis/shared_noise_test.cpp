// Noise that a neighbouring sensor feels, too, and noise that is a few lines in truth.

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <numbers>

#include "core/diagnosis/diagnose.h"
#include "tests/core/diagnosis/subject_of.h"
#include "tests/support/figures_alone.h"

namespace imunoise {
namespace {

using Series = std::vector<double>;

Diagnosis diagnosed_beside(const std::vector<Series>& gyro, NamedChannel other,
                           const std::vector<Series>& measured, Quantity quantity, Hertz rate) {
  std::vector<Signal> replicates;
  for (std::size_t k = 0; k < gyro.size(); ++k) {
    replicates.emplace_back(std::span<const double>(gyro[k]), rate, Quantity::kAngularRate);
    other.replicates.emplace_back(std::span<const double>(measured[k]), rate, quantity);
  }
  return diagnose(fitted(std::make_shared<const Subject>(make_subject(replicates, {other}))));
}

// A gyroscope beside another one, which is noisier. Of a `motion` that both feel, or only the
// first; or of one of its own, and the neighbour leaks into it.
Diagnosis beside_another(double felt, double leaked, double strength = 1.0,
                         const char* motion = "AR1(phi=0.9, sigma2=0.04)", Hertz rate = {50.0}) {
  constexpr std::size_t kSamples = 16'384;
  constexpr std::uint32_t kReplicates = 4;
  const auto made = [&](const char* model, std::uint64_t seed, std::uint32_t k) {
    return simulate(*parse_model(model, rate), kSamples, seed, k);
  };
  std::vector<Series> own;
  std::vector<Series> other;
  for (std::uint32_t k = 0; k < kReplicates; ++k) {
    const Series shaking = made(motion, 21, k);
    own.push_back(made("WN(sigma2=1) + RW(gamma2=1e-5)", 22, k));
    other.push_back(made("WN(sigma2=9) + RW(gamma2=1e-5)", 23, k));
    for (std::size_t t = 0; t < kSamples; ++t) {
      own[k][t] += strength * shaking[t] + leaked * other[k][t];
      other[k][t] += felt * strength * shaking[t];
    }
  }
  return diagnosed_beside(own, {"gyro_y", {}}, other, Quantity::kAngularRate, rate);
}

// A gyroscope that turns, and its neighbour, which feels a share of this: the turning leaks, the
// noise of the other does not.
Diagnosis feels_a_share(double share, const char* motion = "AR1(phi=0.97, sigma2=4)") {
  constexpr Hertz kRate{50.0};
  const auto made = [&](const char* model, std::uint64_t seed, std::uint32_t k) {
    return simulate(*parse_model(model, kRate), 16'384, seed, k);
  };
  std::vector<Series> own;
  std::vector<Series> other;
  for (std::uint32_t k = 0; k < 4; ++k) {
    const Series turning = made(motion, 81, k);
    own.push_back(made("WN(sigma2=1) + RW(gamma2=1e-5)", 82, k));
    other.push_back(made("WN(sigma2=1) + RW(gamma2=1e-5)", 83, k));
    for (std::size_t t = 0; t < turning.size(); ++t) {
      own[k][t] += share * turning[t];
      other[k][t] += turning[t];
    }
  }
  return diagnosed_beside(own, {"gyro_y", {}}, other, Quantity::kAngularRate, kRate);
}

TEST(Diagnose, ASmallShareOfAMotionMayLeakFromAnotherAxis) {
  FIGURES_ALONE();
  const auto may_leak = [](const Diagnosis& diagnosis) {
    const std::vector<std::string>& with = diagnosis.effects.at(0).confused_with;
    return diagnosis.effects[0].tried.cause == "cross_axis" ||
           std::find(with.begin(), with.end(), "cross_axis") != with.end();
  };
  EXPECT_TRUE(may_leak(feels_a_share(0.05)));
  EXPECT_FALSE(may_leak(feels_a_share(0.7)));
}

// The neighbour's noise hides part of the motion. Of a small share, nothing shows beside the
// coupling; of a larger one, that part is noise.
TEST(Diagnose, OnlyAHiddenPartThatShowsIsNoise) {
  FIGURES_ALONE();
  const char* const motion = "AR1(phi=0.8, sigma2=0.36)";
  const Diagnosis small = feels_a_share(0.16, motion);
  ASSERT_NE(small.effects.at(0).tried.term(), nullptr);
  const std::string term = print(*small.effects[0].tried.term());
  EXPECT_TRUE(term.starts_with("witness(gyro_y, noise=0.14")) << term;
  EXPECT_EQ(feels_a_share(0.4, motion).effects.at(0).tried.shared_with, "gyro_y");
}

TEST(Diagnose, NoiseThatTheNeighbourFeelsTooIsVibration) {
  FIGURES_ALONE();
  const Diagnosis diagnosis = beside_another(1.0, 0.0);
  ASSERT_FALSE(diagnosis.effects.empty());
  EXPECT_EQ(diagnosis.effects[0].tried.cause, "common_vibration");
  EXPECT_EQ(diagnosis.effects[0].tried.shared_with, "gyro_y");
}

// The neighbour's noise hides what is faster than 0.1 Hz.
TEST(Diagnose, SlowNoiseThatTheNeighbourFeelsTooIsNoVibration) {
  const Diagnosis diagnosis = beside_another(1.0, 0.0, 1.0, "AR1(phi=0.9995, sigma2=2e-4)", {10.0});
  ASSERT_FALSE(diagnosis.effects.empty());
  EXPECT_EQ(diagnosis.effects[0].tried.cause, "tilt");
  EXPECT_EQ(diagnosis.effects[0].tried.shared_with, "gyro_y");
}

// A gyroscope and an accelerometer on a bench that rocks at `frequency` Hz, damped; `angle`: what
// drives it, rad.
Diagnosis on_a_rocking_bench(Hertz rate, double frequency, double angle, const char* gyro_noise,
                             const char* acceleration_noise, std::size_t samples,
                             std::uint64_t seed) {
  constexpr std::uint32_t kReplicates = 4;
  constexpr double kGravity = 9.80665;
  const double turn = 2.0 * std::numbers::pi * frequency / rate.value;
  const double damping = std::exp(-0.2 * turn);
  const auto made = [&](const char* model, std::uint64_t more, std::uint32_t k) {
    return simulate(*parse_model(model, rate), samples, seed + more, k);
  };
  std::vector<Series> gyro;
  std::vector<Series> acceleration;
  for (std::uint32_t k = 0; k < kReplicates; ++k) {
    Series at = made("WN(sigma2=1)", 0, k);
    for (double& x : at) x *= angle;
    gyro.push_back(made(gyro_noise, 1, k));
    acceleration.push_back(made(acceleration_noise, 2, k));
    for (std::size_t t = 2; t < samples; ++t) {
      at[t] += 2.0 * damping * std::cos(turn) * at[t - 1] - damping * damping * at[t - 2];
      gyro[k][t] += (at[t] - at[t - 1]) * rate.value;
      acceleration[k][t] += kGravity * at[t];
    }
  }
  return diagnosed_beside(gyro, {"acc_x", {}}, acceleration, Quantity::kAcceleration, rate);
}

// The accelerometer sees gravity turn, beneath noise of its own: alone it shows less than the
// gyroscope's spectrum does.
TEST(Diagnose, NoiseThatTheAccelerometerSeesTurnIsTilt) {
  FIGURES_ALONE();
  const Diagnosis diagnosis = on_a_rocking_bench(
      Hertz{10.0}, 0.04, 5e-3, "WN(sigma2=1) + RW(gamma2=1e-6)", "WN(sigma2=150)", 16'384, 31);
  ASSERT_FALSE(diagnosis.effects.empty());
  const TriedTerm& best = diagnosis.effects[0].tried;
  EXPECT_EQ(best.cause, "tilt");
  EXPECT_EQ(best.shared_with, "acc_x");
}

// Its noise hides the more of the rocking the faster that is.
TEST(Diagnose, TiltIsTakenOutOctaveByOctave) {
  const Diagnosis diagnosis = on_a_rocking_bench(
      Hertz{10.0}, 0.03, 1e-2, "WN(sigma2=1) + RW(gamma2=1e-3)", "WN(sigma2=30)", 8192, 61);
  ASSERT_TRUE(diagnosis.worth_adding);
  const TriedTerm& best = diagnosis.effects[0].tried;
  EXPECT_EQ(best.cause, "tilt");
  ASSERT_FALSE(best.fitted.regression.effects().empty());
  EXPECT_GT(best.fitted.regression.effects()[0]["octaves"], 1.0);
}

// The rocking looks like the gyroscope's walk. Where the slow part of it is taken out, what the
// accelerometer's noise hides is left: noise that no walk describes.
TEST(Diagnose, WhatIsHiddenOfATiltIsNoiseBesideIt) {
  const Diagnosis diagnosis = on_a_rocking_bench(
      Hertz{100.0}, 0.03, 5e-4, "WN(sigma2=1) + RW(gamma2=8e-4)", "WN(sigma2=50)", 8192, 71);
  ASSERT_TRUE(diagnosis.worth_adding);
  const TriedTerm& best = diagnosis.effects[0].tried;
  EXPECT_EQ(best.cause, "tilt");
  EXPECT_EQ(best.shared_with, "acc_x");
  EXPECT_GT(misfit_of(best.fitted).spectrum.p_value, 1e-3);
}

// A wave that beats has the spectrum of a narrow resonance; its power lies in three lines.
TEST(Diagnose, AWaveThatBeatsIsNoResonanceForSure) {
  constexpr Hertz kRate{100.0};
  constexpr std::size_t kSamples = 8192;
  const auto best = [&](bool beats) {
    std::vector<Series> all;
    std::vector<Signal> replicates;
    for (std::uint32_t k = 0; k < 4; ++k) {
      all.push_back(
          simulate(*parse_model("WN(sigma2=1) + RW(gamma2=1e-6)", kRate), kSamples, 41, k));
      Series ringing = simulate(*parse_model("WN(sigma2=4e-5)", kRate), kSamples, 42, k);
      const double turn = 2.0 * std::numbers::pi * 17.3 / kRate.value;
      const double damping = std::exp(-0.006 * turn);
      for (std::size_t t = 2; t < kSamples; ++t) {
        ringing[t] +=
            2.0 * damping * std::cos(turn) * ringing[t - 1] - damping * damping * ringing[t - 2];
        const auto i = static_cast<double>(t);
        const double swing = 1.0 + std::sin(2.0 * std::numbers::pi * 20.3 * i / kSamples + k);
        all[k][t] += beats ? 0.25 * swing * std::sin(turn * i + 2.0 * k) : 3.0 * ringing[t];
      }
    }
    for (const Series& one : all)
      replicates.emplace_back(std::span<const double>(one), kRate, Quantity::kAngularRate);
    Diagnosis out = diagnose(fitted(std::make_shared<const Subject>(make_subject(replicates, {}))));
    EXPECT_FALSE(out.effects.empty());
    return std::move(out.effects.front());
  };
  const auto says_line = [](const RankedTerm& one) {
    const auto& confused = one.confused_with;
    return std::find(confused.begin(), confused.end(), "line") != confused.end();
  };
  const RankedTerm beating = best(true);
  const RankedTerm ringing = best(false);
  EXPECT_EQ(beating.tried.cause, "line");
  EXPECT_EQ(ringing.tried.cause, "resonance");
  EXPECT_FALSE(says_line(ringing));
}

TEST(Diagnose, NoiseThatTheNeighbourDoesNotFeelIsItsOwn) {
  FIGURES_ALONE();
  const Diagnosis diagnosis = beside_another(0.0, 0.0);
  ASSERT_FALSE(diagnosis.effects.empty());
  EXPECT_EQ(diagnosis.effects[0].tried.cause, "gauss_markov");
}

TEST(Diagnose, NoiseThatTheNeighbourHardlyFeelsIsItsOwn) {
  FIGURES_ALONE();
  const Diagnosis diagnosis = beside_another(0.02, 0.0, 10.0);
  ASSERT_FALSE(diagnosis.effects.empty());
  EXPECT_EQ(diagnosis.effects[0].tried.cause, "gauss_markov");
}

TEST(Diagnose, ALeakBesideNoiseOfItsOwnMakesNoVibrationOfIt) {
  FIGURES_ALONE();
  const Diagnosis diagnosis = beside_another(0.0, 0.1);
  for (const RankedTerm& one : diagnosis.effects) EXPECT_TRUE(one.tried.shared_with.empty());
  const auto markov =
      std::find_if(diagnosis.effects.begin(), diagnosis.effects.end(),
                   [](const RankedTerm& one) { return one.tried.cause == "gauss_markov"; });
  EXPECT_NE(markov, diagnosis.effects.end());
}

}  // namespace
}  // namespace imunoise
