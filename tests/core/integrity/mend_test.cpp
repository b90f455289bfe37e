// What is mended has the second moments of what was never broken.

#include "core/integrity/mend.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <functional>

#include "core/model/model.h"
#include "core/wavelet/wavelet_variance.h"
#include "tests/support/figures_alone.h"

namespace imunoise {
namespace {

constexpr Hertz kMendRate{100.0};
constexpr std::size_t kMendSamples = 400'000;
constexpr std::uint64_t kMendSeed = 11;

Signal signal_of(const std::vector<double>& x) {
  return {std::span<const double>(x), kMendRate, Quantity::kAngularRate};
}

// The first scales' variances: mean squares of differences of neighbouring block means.
double haar_variance(const std::vector<double>& x, std::size_t half) {
  double sum = 0.0;
  std::size_t count = 0;
  for (std::size_t t = 0; t + 2 * half <= x.size(); ++t, ++count) {
    double difference = 0.0;
    for (std::size_t i = 0; i < half; ++i) difference += x[t + half + i] - x[t + i];
    sum += difference * difference;
  }
  return sum / static_cast<double>(count * half * half);
}

// Nine standard deviations in ten thousand lie beyond; neighbouring differences of white noise
// share samples, which costs a factor of 3 in variance at the first scale, 8/3 later.
double bound(std::size_t half) {
  return 4.0 * std::sqrt(3.0 * static_cast<double>(half) / kMendSamples);
}

struct BrokenNoise {
  std::vector<double> sound;
  std::vector<double> broken;
};

std::vector<double> mend_all(const std::vector<double>& broken) {
  std::vector<WrongSample> wrong;
  for (const Defect& one : integrity(signal_of(broken)))
    wrong.insert(wrong.end(), one.wrong.begin(), one.wrong.end());
  std::sort(wrong.begin(), wrong.end(),
            [](const WrongSample& a, const WrongSample& b) { return a.at < b.at; });
  return mended(signal_of(broken), wrong);
}

void expect_mended(const std::string& model,
                   const std::function<void(std::vector<double>&)>& hurt) {
  const std::vector<double> sound =
      simulate(*parse_model(model, kMendRate), kMendSamples, kMendSeed, 0);
  std::vector<double> broken = sound;
  hurt(broken);
  const std::vector<double> whole = mend_all(broken);
  bool harmed = false;
  for (const std::size_t half : {1U, 2U, 4U, 8U, 64U, 512U}) {
    const double truth = haar_variance(sound, half);
    harmed |= std::abs(haar_variance(broken, half) / truth - 1.0) > bound(half);
    EXPECT_NEAR(haar_variance(whole, half) / truth, 1.0, bound(half))
        << model << " at " << half << ", broken " << haar_variance(broken, half) / truth
        << ", seed " << kMendSeed;
  }
  EXPECT_TRUE(harmed) << "nothing to mend";
}

void repeat_some(std::vector<double>& x) {
  for (std::size_t t = 23; t < x.size(); t += t % 3 == 0 ? 17U : 31U) x[t] = x[t - 1];
}

void cut_off_at(std::vector<double>& x, double limit) {
  for (double& one : x) one = std::clamp(one, -limit, limit);
}

TEST(Mend, SamplesThatRepeat) {
  FIGURES_ALONE();
  for (const char* const model : {"WN(sigma2=1)", "WN(sigma2=1) + RW(gamma2=0.01)",
                                  "WN(sigma2=0.2) + AR1(phi=0.9, sigma2=0.2)"})
    expect_mended(model, repeat_some);
}

TEST(Mend, SamplesThatWereCutOff) {
  expect_mended("WN(sigma2=1)", [](auto& x) { cut_off_at(x, 2.0); });
  expect_mended("WN(sigma2=0.5) + AR1(phi=0.9, sigma2=0.095)", [](auto& x) { cut_off_at(x, 2.1); });
}

TEST(Mend, NothingElseIsTouchedAndWhatWasCutOffLiesBeyond) {
  std::vector<double> x = simulate(*parse_model("WN(sigma2=1)", kMendRate), 20'000, kMendSeed, 0);
  cut_off_at(x, 2.5);
  const std::vector<double> whole = mend_all(x);
  EXPECT_EQ(whole, mend_all(x)) << "not the same twice";
  std::size_t beyond = 0;
  for (std::size_t t = 0; t < x.size(); ++t) {
    if (std::abs(x[t]) == 2.5) {
      EXPECT_GE(std::abs(whole[t]), 2.5);
      EXPECT_EQ(std::signbit(whole[t]), std::signbit(x[t]));
      ++beyond;
    } else {
      EXPECT_EQ(whole[t], x[t]);
    }
  }
  EXPECT_GT(beyond, 100U);
}

TEST(Mend, ASeriesThatNoNeighbourTellsAboutStaysAsItIs) {
  const std::vector<double> x{1.0, 1.0, 1.0};
  const std::vector<WrongSample> all{{0, 0}, {1, 0}, {2, 0}};
  EXPECT_EQ(mended(signal_of(x), all), x);
}

}  // namespace
}  // namespace imunoise
