// The views of a model beside the data: spectrum, kurtosis, pairs of sensors, lags. What is put in
// is seen where it is, and only there.

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

#include "core/diagnosis/views/lag_curves.h"
#include "core/diagnosis/views/scale_kurtosis.h"
#include "core/diagnosis/views/sensor_pairs.h"
#include "core/diagnosis/views/spectral_view.h"
#include "tests/core/diagnosis/subject_of.h"

namespace imunoise {
namespace {

double swing(std::size_t k, double s) {
  return 2.0 * wave(0.013 + 0.002 * static_cast<double>(k), s) + wave(0.05, s + 3.0);
}

// A trial that a Current may borrow from.
struct Looked {
  FittedModel trial;
  Current current;
  explicit Looked(const MadeSubject& made)
      : trial(fitted(subject_of(made))), current(current_of(trial.regression, trial.fit)) {}
};

TEST(SpectralView, CoversTheModelThatTheDataComeFrom) {
  const Looked at({.seed = 21});
  const auto points = spectral_view(at.current);
  ASSERT_GT(points.size(), 60U);
  const auto outside = std::count_if(points.begin(), points.end(), [](const SpectrumPoint& one) {
    return one.model < one.lower || one.model > one.upper;
  });
  // 5 % of the points; P(more than 12 % of 60 independent ones) < 0.01.
  EXPECT_LT(static_cast<double>(outside), 0.12 * static_cast<double>(points.size()));
  EXPECT_NEAR(points.back().model, 2.0 / 50.0, 0.1 * 2.0 / 50.0);  // one-sided, unit²/Hz
  EXPECT_GT(points.front().model, points.back().model);
}

TEST(SpectralView, AWaveStandsOutAtItsFrequency) {
  const Looked at(
      {.seed = 22, .added = [](std::size_t, double s) { return 0.2 * wave(7.123, s); }});
  const auto points = spectral_view(at.current);
  const auto best = std::max_element(
      points.begin(), points.end(),
      [](const auto& a, const auto& b) { return a.peak / a.model < b.peak / b.model; });
  EXPECT_NEAR(best->frequency, 7.123, 0.08 * 7.123);
  EXPECT_GT(best->peak / best->model, 20.0);  // A²n/4 = 82 shared by two neighbours at worst
}

// What only the longer replicates show is shown.
TEST(SpectralView, SeesReplicatesOfAllLengths) {
  const Looked at({.first = 4096, .seed = 22, .added = [](std::size_t k, double s) {
                     return k > 0 ? 0.2 * wave(7.123, s) : 0.0;
                   }});
  const auto points = spectral_view(at.current);
  const auto best = std::max_element(
      points.begin(), points.end(),
      [](const auto& a, const auto& b) { return a.peak / a.model < b.peak / b.model; });
  EXPECT_NEAR(best->frequency, 7.123, 0.08 * 7.123);
  EXPECT_GT(best->peak / best->model, 15.0);  // three quarters of the 82 of each, at worst a half
  EXPECT_NEAR(points.front().frequency, 50.0 / (2.0 * 8192.0), 1e-9);
}

TEST(Misfit, ReplicatesOfDifferentLengthsShareTheirHalfOctaves) {
  const Looked at({.shorter = 400, .seed = 28, .added = [](std::size_t, double s) {
                     return 0.5 * wave(7.123, s);
                   }});
  const MisfitReport misfit = misfit_of(at.trial);
  for (std::size_t i = 1; i < misfit.bands.size(); ++i)
    EXPECT_GE(misfit.bands[i].from, misfit.bands[i - 1].to);
  const auto worst =
      std::max_element(misfit.bands.begin(), misfit.bands.end(),
                       [](const auto& a, const auto& b) { return a.sigma < b.sigma; });
  EXPECT_LE(worst->from, 7.123);
  EXPECT_GE(worst->to, 7.123);
  EXPECT_EQ(worst->replicates, 4);
}

TEST(ScaleKurtosis, NormalNoiseHasNone) {
  const Looked at({.seed = 23});
  const auto scales = scale_kurtosis(innovations(at.trial.regression, at.trial.fit), 50.0);
  ASSERT_GE(scales.size(), 6U);
  EXPECT_DOUBLE_EQ(scales[0].seconds, 0.02);
  EXPECT_DOUBLE_EQ(scales[1].seconds, 0.04);
  for (const ScaleKurtosis& one : scales) EXPECT_LT(std::abs(one.excess), 4.5 * one.error);
}

TEST(ScaleKurtosis, SingleOutliersFadeAsTimesGrow) {
  const auto spikes = [](std::size_t, double s) {
    return std::lround(50.0 * s) % 997 == 500 ? 9.0 : 0.0;
  };
  const Looked at({.seed = 24, .added = spikes});
  const auto scales = scale_kurtosis(innovations(at.trial.regression, at.trial.fit), 50.0);
  EXPECT_GT(scales[0].excess, 20.0 * scales[0].error);
  EXPECT_GT(scales[0].excess, 2.0 * scales[2].excess);
}

TEST(SensorPairs, SeesWhereTwoChannelsMoveTogether) {
  const Looked at({.seed = 25,
                   .added = [](std::size_t k, double s) { return 0.4 * swing(k, s); },
                   .temperature = swing});
  const auto pairs = sensor_pairs(at.current);
  ASSERT_EQ(pairs.size(), 1U);
  EXPECT_EQ(pairs[0].first, 0U);
  EXPECT_EQ(pairs[0].second, 1U);
  EXPECT_GT(pairs[0].correlation, 0.5);
  EXPECT_LT(pairs[0].p_value, 1e-4);
  EXPECT_LT(pairs[0].from, 0.06);
  EXPECT_GT(pairs[0].to, 0.02);
}

TEST(SensorPairs, WhatIsApartIsAsAlikeAsChance) {
  const Looked at({.seed = 26, .temperature = [](std::size_t k, double s) {
                     return std::fmod(s * 7919.0 + 131.0 * static_cast<double>(k), 1.0);
                   }});
  EXPECT_GT(sensor_pairs(at.current).at(0).p_value, 0.01);
}

TEST(SensorPairs, AHalfLengthReplicateIsNotAnOctaveOff) {
  const auto beside = [](std::size_t k, double s) {
    return std::fmod(s * 7919.0 + 131.0 * static_cast<double>(k), 1.0) + 0.5 * wave(7.123, s);
  };
  const Looked at({.first = 4096,
                   .seed = 25,
                   .added = [](std::size_t, double s) { return 0.3 * wave(7.123, s); },
                   .temperature = beside});
  const auto pairs = sensor_pairs(at.current);
  ASSERT_EQ(pairs.size(), 1U);
  EXPECT_LT(pairs[0].p_value, 1e-4);
  EXPECT_LT(pairs[0].from, 7.123);
  EXPECT_GT(pairs[0].to, 7.123);
  EXPECT_LT(pairs[0].to / pairs[0].from, 1.5);
}

// Blocks of a replicate of twice the length are twice as long: 16,384 samples stand alone.
TEST(LagCurves, AreTheSameForReplicatesOfAllLengths) {
  const auto behind = [](std::size_t k, double s) {
    return 0.5 * (2.0 * lagged_wave(0.013 + 0.002 * static_cast<double>(k), 5.0, s) +
                  lagged_wave(0.05, 5.0, s + 3.0));
  };
  const Looked at({.samples = 65536,
                   .replicates = 3,
                   .first = 16384,
                   .seed = 29,
                   .added = behind,
                   .temperature = swing});
  const auto curves = lag_curves(at.current);
  ASSERT_EQ(curves.size(), 1U);
  const auto best = std::max_element(curves[0].nats.begin(), curves[0].nats.end());
  const double lag = curves[0].seconds.at(static_cast<std::size_t>(best - curves[0].nats.begin()));
  EXPECT_NEAR(std::log2(lag / 5.0), 0.0, 0.5);
}

TEST(LagCurves, PeakBehindTheWitnessThatCauses) {
  const auto behind = [](std::size_t k, double s) {
    return 0.5 * (2.0 * lagged_wave(0.013 + 0.002 * static_cast<double>(k), 5.0, s) +
                  lagged_wave(0.05, 5.0, s + 3.0));
  };
  const Looked at({.seed = 27, .added = behind, .temperature = swing});
  const auto curves = lag_curves(at.current);
  ASSERT_EQ(curves.size(), 1U);
  const auto best = std::max_element(curves[0].nats.begin(), curves[0].nats.end());
  const double lag = curves[0].seconds.at(static_cast<std::size_t>(best - curves[0].nats.begin()));
  EXPECT_NEAR(std::log2(lag / 5.0), 0.0, 0.8);
  EXPECT_GT(*best, curves[0].chance);
  EXPECT_TRUE(std::is_sorted(curves[0].seconds.begin(), curves[0].seconds.end()));
  EXPECT_LT(curves[0].seconds.front(), 0.0);
}

}  // namespace
}  // namespace imunoise
