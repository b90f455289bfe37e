// The detector on simulated arrays: as many false alarms as were allowed, the right sensor named,
// and delays against theory.

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <cstdio>

#include "tests/core/faults/faulty_array.h"
#include "tests/support/figures_alone.h"

namespace imunoise {
namespace {

using testing::array_model;
using testing::coloured_model;
using testing::faults_in;
using testing::reading;
using testing::Readings;

constexpr std::uint64_t kSeed = 20261121;
constexpr std::size_t kOnset = 3000;

Readings healthy(const ArrayModel& model, std::uint32_t set, std::size_t samples = 2 * kOnset) {
  return testing::simulated_array(model, samples, kSeed, set);
}

FaultDetector detector_of(const ArrayModel& model, double an_hour = 1e-3) {
  FaultOptions options;
  options.false_alarms_per_hour = an_hour;
  options.longest = 1 << 14;
  return {model, Hertz{1.0}, options};
}

bool is_only(const Fault& fault, FaultKind kind, std::size_t sensor) {
  return fault.kind == kind && fault.sensors == std::vector{static_cast<Eigen::Index>(sensor)};
}

TEST(FaultDetector, NamesTheSensorThatSteps) {
  const ArrayModel model = coloured_model();
  const FaultDetector designed = detector_of(model);
  int right = 0;
  constexpr int kRuns = 24;
  for (std::uint32_t run = 0; run < kRuns; ++run) {
    Readings data = healthy(model, run);
    const std::size_t sensor = run % 3;
    for (std::size_t t = kOnset; t < data[sensor].size(); ++t) data[sensor][t] += 4.0;
    FaultDetector detector = designed;
    const std::vector<Fault> found = faults_in(detector, data);
    ASSERT_FALSE(found.empty()) << run;
    const Fault& fault = found.front();
    const bool named = is_only(fault, FaultKind::kStep, sensor);
    right += named ? 1 : 0;
    if (!named) continue;
    EXPECT_NEAR(fault.size, 4.0, 4.5 * fault.size_error);
    EXPECT_NEAR(static_cast<double>(fault.onset), kOnset, 12.0);
    EXPECT_GE(fault.detected, kOnset);
    EXPECT_LT(fault.detected, kOnset + 20);
    EXPECT_EQ(detector.watched().size(), 3U) << "a sensor that stepped is still watched";
  }
  std::printf("%d of %d steps named\n", right, kRuns);
  EXPECT_GE(right, kRuns - 2);
}

// A level that comes back is no step, and its sensor goes on being watched.
TEST(FaultDetector, ASpikeIsShortNoise) {
  const ArrayModel model = coloured_model();
  const FaultDetector designed = detector_of(model);
  constexpr std::uint32_t kRuns = 24;
  for (const std::size_t length : {1U, 3U}) {
    int right = 0;
    for (std::uint32_t run = 0; run < kRuns; ++run) {
      Readings data = healthy(model, run);
      const std::size_t sensor = run % 3;
      for (std::size_t t = kOnset; t < kOnset + length; ++t) data[sensor][t] += 20.0;
      FaultDetector detector = designed;
      const std::vector<Fault> found = faults_in(detector, data);
      ASSERT_FALSE(found.empty()) << run;
      const Fault& fault = found.front();
      const bool named = is_only(fault, FaultKind::kNoisy, sensor);
      right += named ? 1 : 0;
      if (!named) continue;
      EXPECT_NEAR(static_cast<double>(fault.end), static_cast<double>(kOnset + length), 8.0);
      EXPECT_EQ(detector.watched().size(), 3U);
    }
    std::printf("%d of %u spikes of %zu readings named\n", right, kRuns, length);
    EXPECT_GE(right, static_cast<int>(kRuns) - 2) << length;
  }
}

TEST(FaultDetector, NamesTheSensorThatGrowsNoisy) {
  FIGURES_ALONE();
  const ArrayModel model = coloured_model();
  const FaultDetector designed = detector_of(model);
  int right = 0;
  constexpr int kRuns = 12;
  std::vector<double> sizes;
  for (std::uint32_t run = 0; run < kRuns; ++run) {
    Readings data = healthy(model, run);
    const std::size_t sensor = run % 3;
    RandomStream random(kSeed, {run, 99});
    for (std::size_t t = kOnset; t < data[sensor].size(); ++t) {
      data[sensor][t] += 2.0 * random.normal();
    }
    FaultDetector detector = designed;
    const std::vector<Fault> found = faults_in(detector, data);
    ASSERT_FALSE(found.empty()) << run;
    const Fault& fault = found.front();
    const bool named = fault.kind == FaultKind::kNoisy && fault.sensors.size() == 1 &&
                       fault.sensors.front() == static_cast<Eigen::Index>(sensor);
    right += named ? 1 : 0;
    if (!named) continue;
    sizes.push_back(fault.size);
    EXPECT_LT(fault.detected, kOnset + 150);
    EXPECT_EQ(detector.watched().size(), 2U);
  }
  std::printf("%d of %d noisy sensors named\n", right, kRuns);
  std::sort(sizes.begin(), sizes.end());
  EXPECT_NEAR(sizes[sizes.size() / 2], 2.0, 0.5);  // by the strongest window: a little too large
  EXPECT_GE(right, kRuns - 2);
}

TEST(FaultDetector, NamesTheSensorThatSticksAndGoesOnWithTheOthers) {
  FIGURES_ALONE();
  const ArrayModel model = coloured_model();
  constexpr double kStep = 0.1;  // of the converter
  FaultOptions options;
  options.false_alarms_per_hour = 1e-3;
  options.longest = 1 << 14;
  options.resolution = {kStep, kStep, kStep};
  const FaultDetector designed(model, Hertz{1.0}, options);
  for (std::uint32_t run = 0; run < 12; ++run) {
    Readings data = healthy(model, run);
    const std::size_t sensor = run % 3;
    const std::size_t other = (run + 1) % 3;
    for (std::size_t t = 0; t < data[0].size(); ++t) {
      if (t >= kOnset + 1500) data[other][t] += 8.0;
      for (auto& one : data) one[t] = kStep * std::round(one[t] / kStep);
      if (t >= kOnset) data[sensor][t] = data[sensor][kOnset - 1];
    }
    FaultDetector detector = designed;
    const std::vector<Fault> found = faults_in(detector, data);
    ASSERT_EQ(found.size(), 2U) << run;
    EXPECT_EQ(found[0].kind, FaultKind::kStuck);
    EXPECT_EQ(found[0].sensors, std::vector{static_cast<Eigen::Index>(sensor)});
    EXPECT_LE(found[0].onset, kOnset);
    EXPECT_LE(found[0].detected, found[0].onset + designed.repetitions()[sensor] - 1);
    // Two are left: one of them stepped, and nobody can say which.
    EXPECT_EQ(found[1].kind, FaultKind::kStep);
    EXPECT_EQ(found[1].sensors.size(), 2U);
  }
}

// Readings of twice the noise's resolution repeat by themselves, and one that sticks off the mean
// looks like a step, too: both together are more likely of a sensor that sticks.
TEST(FaultDetector, CoarseReadingsThatStickOffTheMeanAreNoStep) {
  constexpr double kStep = 2.0;
  const ArrayModel model = array_model("WN", 3, {1.0 + kStep * kStep / 12.0});
  FaultOptions options;
  options.false_alarms_per_hour = 1e-3;
  options.longest = 1 << 12;
  options.resolution = {kStep, kStep, kStep};
  const FaultDetector designed(model, Hertz{1.0}, options);
  const ArrayModel white = array_model("WN", 3, {1.0});
  int right = 0;
  constexpr int kRuns = 24;
  for (std::uint32_t run = 0; run < kRuns; ++run) {
    Readings data = healthy(white, run, kOnset + 500);
    const std::size_t sensor = run % 3;
    for (auto& one : data) {
      for (double& x : one) x = kStep * std::round(x / kStep);
    }
    for (std::size_t t = kOnset; t < data[sensor].size(); ++t) data[sensor][t] = 2.0 * kStep;
    FaultDetector detector = designed;
    const std::vector<Fault> found = faults_in(detector, data);
    ASSERT_FALSE(found.empty()) << run;
    right += is_only(found.front(), FaultKind::kStuck, sensor) ? 1 : 0;
  }
  std::printf("%d of %d stuck sensors named\n", right, kRuns);
  EXPECT_EQ(right, kRuns);
}

TEST(FaultDetector, TellsTwoSensorsApartByTheirNoiseOnly) {
  const ArrayModel model = array_model("RW[corr] + WN", 2, {1e-5, 1.0}, 0.5);
  const FaultDetector designed = detector_of(model);
  int right = 0;
  constexpr int kRuns = 20;
  for (std::uint32_t run = 0; run < kRuns; ++run) {
    Readings data = healthy(model, run);
    const std::size_t sensor = run % 2;
    RandomStream random(kSeed, {run, 99});
    Readings stepped = data;
    for (std::size_t t = kOnset; t < data[sensor].size(); ++t) {
      data[sensor][t] += 3.0 * random.normal();
      stepped[sensor][t] += 6.0;
    }
    FaultDetector detector = designed;
    const std::vector<Fault> noisy = faults_in(detector, data);
    ASSERT_FALSE(noisy.empty());
    const bool named = noisy[0].kind == FaultKind::kNoisy &&
                       noisy[0].sensors == std::vector{static_cast<Eigen::Index>(sensor)};
    right += named ? 1 : 0;
    detector = designed;
    const std::vector<Fault> step = faults_in(detector, stepped);
    ASSERT_FALSE(step.empty());
    EXPECT_EQ(step[0].kind, FaultKind::kStep);
    EXPECT_EQ(step[0].sensors, (std::vector<Eigen::Index>{0, 1}));
  }
  EXPECT_GE(right, kRuns - 2);
}

TEST(FaultDetector, MotionOfAllSensorsIsNoFault) {
  const ArrayModel model = coloured_model();
  FaultDetector detector = detector_of(model);
  Readings data = healthy(model, 0);
  for (std::size_t t = kOnset; t < data[0].size(); ++t) {
    const double motion = 1e3 * std::sin(0.3 * static_cast<double>(t)) + 500.0;
    for (auto& one : data) one[t] += motion;
  }
  EXPECT_TRUE(faults_in(detector, data).empty());
}

TEST(FaultDetector, NoFaultBeginsAfterItsAlarm) {
  FIGURES_ALONE();
  const ArrayModel model = coloured_model();
  const FaultDetector designed = detector_of(model, 30.0);  // false alarms, to see many
  int alarms = 0;
  for (std::uint32_t run = 0; run < 12; ++run) {
    FaultDetector detector = designed;
    for (const Fault& fault : faults_in(detector, healthy(model, run))) {
      ++alarms;
      EXPECT_LE(fault.onset, fault.detected) << "run " << run;
    }
  }
  EXPECT_GE(alarms, 50);
}

TEST(FaultDetector, SaysWhichModelHasNoParityNoise) {
  EXPECT_TRUE(parity_is_noisy(coloured_model()));
  EXPECT_FALSE(parity_is_noisy(array_model("RW[all] + WN[all]", 3, {1e-4, 1.0})));
}

TEST(StuckWatch, GivesUpWhereTheConverterIsCoarserThanTheNoise) {
  const ArrayModel model = array_model("WN", 2, {1.0});
  const StuckWatch watch(model, {0, 1}, {0.1, 20.0}, 1e-9);
  // Each repetition is as likely as 0.1 / √(2π·S), S falling from 2 to 1: nine of them.
  EXPECT_GE(watch.repetitions()[0], 6U);
  EXPECT_LE(watch.repetitions()[0], 7U);
  EXPECT_EQ(watch.repetitions()[1], 0U);
}

}  // namespace
}  // namespace imunoise
