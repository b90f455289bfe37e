// Defects of the samples themselves, and none where there are none.

#include "core/integrity/integrity.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <vector>

#include "core/integrity/interpolation.h"
#include "core/support/random.h"

namespace imunoise {
namespace {

constexpr std::size_t kSamples = 20'000;

// Normal numbers, rounded to a step where there is one.
std::vector<double> noise(double step) {
  RandomStream rng(5);
  std::vector<double> out(kSamples);
  for (double& one : out) {
    one = rng.normal();
    if (step > 0.0) one = step * std::round(one / step);
  }
  return out;
}

std::vector<std::string> effects(const std::vector<double>& samples) {
  std::vector<std::string> out;
  for (const Defect& one : integrity(Signal(std::span<const double>(samples), Hertz{100.0})))
    out.push_back(one.effect);
  return out;
}

using Names = std::vector<std::string>;

TEST(Integrity, SoundSamplesAreLeftAlone) {
  EXPECT_EQ(effects(noise(0.0)), Names{});
  EXPECT_EQ(effects(noise(0.01)), Names{});
  EXPECT_EQ(effects(noise(0.5)), Names{});
}

// With six decimals some samples of many repeat the one before, whatever the noise: of white noise
// n·step/(2√π), 3.4 here; of noise whose neighbours are alike more. Too many values occur to count
// each.
TEST(Integrity, PrintedDecimalsAreNoDefect) {
  constexpr std::size_t kMany = 300'000;
  constexpr double kPrinted = 4e-5;
  for (const double phi : {0.0, 0.95}) {
    RandomStream rng(7);
    std::vector<double> printed(kMany);
    double state = 0.0;
    std::size_t repeats = 0;
    for (std::size_t t = 0; t < kMany; ++t) {
      state = phi * state + std::sqrt(1.0 - phi * phi) * rng.normal();
      printed[t] = kPrinted * std::round(state / kPrinted);
      repeats += t > 0 && printed[t] == printed[t - 1] ? 1U : 0U;
    }
    EXPECT_GE(repeats, 1U) << phi;
    EXPECT_EQ(effects(printed), Names{}) << "phi " << phi << ", " << repeats << " repeats";
  }
}

TEST(Integrity, CodesThatNeverOccurAreMissingAndNoDuplicates) {
  constexpr double kStep = 0.2;
  std::vector<double> codes = noise(kStep);
  for (double& one : codes) {
    const double code = std::round(one / kStep);
    if (code == -3.0 || code == 1.0 || code == 4.0) one = kStep * (code + 1.0);
  }
  const auto found = integrity(Signal(std::span<const double>(codes), Hertz{100.0}));
  ASSERT_EQ(found.size(), 1U);
  EXPECT_EQ(found[0].effect, "missing_codes");
  EXPECT_EQ(found[0].count, 3U);
}

// White noise of 97, 130 and 61 Hz, read at 100 Hz between its samples; each with a walk.
TEST(Integrity, InterpolationBeatsWithTheOriginalRate) {
  for (const double ratio : {0.97, 1.3, 0.61}) {
    RandomStream rng(6);
    std::vector<double> raw(2 * kSamples);
    double walk = 0.0;
    for (double& one : raw) one = rng.normal() + (walk += 0.01 * rng.normal());
    std::vector<double> read(kSamples);
    for (std::size_t i = 0; i < kSamples; ++i) {
      const double at = ratio * static_cast<double>(i);
      const auto left = static_cast<std::size_t>(at);
      const double along = at - static_cast<double>(left);
      read[i] = (1.0 - along) * raw[left] + along * raw[left + 1];
    }
    const double beat = std::abs(ratio - std::round(ratio));
    EXPECT_NEAR(interpolation_beat(read), beat, 1e-5) << ratio;
    EXPECT_EQ(effects(read), Names{"interpolated_samples"}) << ratio;
  }
}

// Power that rises and falls as evenly, a strong line, and noise that passed a filter are none.
TEST(Integrity, EvenPowerChangesAreNoInterpolation) {
  std::vector<double> beating = noise(0.0);
  std::vector<double> line = noise(0.0);
  std::vector<double> smooth = noise(0.0);
  for (std::size_t i = 0; i < kSamples; ++i) {
    const auto t = static_cast<double>(i);
    beating[i] *= std::exp(0.45 * std::cos(0.0628 * t));
    line[i] += 3.0 * std::sin(0.7 * t);
    if (i > 0) smooth[i] = 0.5 * smooth[i - 1] + 0.5 * smooth[i];
  }
  for (const auto* one : {&beating, &line, &smooth}) EXPECT_EQ(interpolation_beat(*one), 0.0);
}

TEST(Integrity, AValueFarFromAllOthersIsNoEndOfTheRange) {
  std::vector<double> zeros = noise(0.01);
  for (double& one : zeros) one += 20.0;
  for (std::size_t t = 77; t < kSamples; t += 300) zeros[t] = 0.0;
  const auto found = integrity(Signal(std::span<const double>(zeros), Hertz{100.0}));
  ASSERT_EQ(found.size(), 1U);
  EXPECT_EQ(found[0].effect, "dropouts");
  EXPECT_EQ(found[0].number, 0.0);
  ASSERT_FALSE(found[0].wrong.empty());
  EXPECT_EQ(found[0].wrong.front().beyond, 0);
}

TEST(Integrity, EachDefectIsNamed) {
  std::vector<double> repeated = noise(0.01);
  for (std::size_t t = 101; t < kSamples; t += 100) repeated[t] = repeated[t - 1];
  EXPECT_EQ(effects(repeated), Names{"duplicated_samples"});

  std::vector<double> held = noise(0.01);
  std::fill(held.begin() + 5000, held.begin() + 5020, held[5000]);
  EXPECT_EQ(effects(held), Names{"stuck"});

  std::vector<double> clipped = noise(0.01);
  for (double& one : clipped) one = std::min(one, 2.5);
  EXPECT_EQ(effects(clipped), Names{"saturation"});

  // What lies at an end again and again repeats itself, which is no other defect.
  std::vector<double> wandering = noise(0.01);
  for (std::size_t t = 0; t < kSamples; ++t) {
    const double slow = 1.5 * std::sin(0.002 * static_cast<double>(t));
    wandering[t] = std::clamp(wandering[t] + slow, -2.0, 2.0);
  }
  EXPECT_EQ(effects(wandering), (Names{"saturation", "saturation"}));

  // Noise of three steps that changes little from one sample to the next.
  std::vector<double> smooth = noise(0.0);
  double slow = 0.0;
  for (double& one : smooth) one = std::round(3.0 * (slow += 0.02 * (7.0 * one - slow)));
  EXPECT_EQ(effects(smooth), Names{});
  // It creeps.
  smooth = noise(0.0);
  for (double& one : smooth) one = std::round(2.0 * (slow += 0.002 * (20.0 * one - slow)));
  EXPECT_EQ(effects(smooth), Names{"quantisation"});

  EXPECT_EQ(effects(noise(4.0)), Names{"quantisation"});
  EXPECT_EQ(effects(noise(1.8)), Names{"quantisation"});
  EXPECT_EQ(effects(std::vector<double>(100, 3.0)), Names{"stuck"});
}

TEST(StuckRuns, AreFoundWhereTheyAre) {
  std::vector<double> held = noise(0.01);
  std::fill(held.begin() + 5000, held.begin() + 5020, held[5000]);
  std::fill(held.begin() + 9000, held.begin() + 9400, held[9000]);
  const auto runs = stuck_runs(Signal(std::span<const double>(held), Hertz{100.0}));
  ASSERT_EQ(runs.size(), 2U);
  EXPECT_EQ(runs[0].first, 5000U);
  EXPECT_EQ(runs[0].count, 20U);
  EXPECT_EQ(runs[1].first, 9000U);
  EXPECT_EQ(runs[1].count, 400U);
}

TEST(StuckRuns, ACoarseConverterIsNotStuck) {
  const std::vector<double> coarse = noise(4.0);
  EXPECT_TRUE(stuck_runs(Signal(std::span<const double>(coarse), Hertz{100.0})).empty());
  const std::vector<double> fine = noise(0.5);
  EXPECT_TRUE(stuck_runs(Signal(std::span<const double>(fine), Hertz{100.0})).empty());
}

}  // namespace
}  // namespace imunoise
