// Clocks of known error, behind a way to the host that delays by chance.

#include "recording/store/timeline/device_clock.h"

#include <gtest/gtest.h>

#include <cmath>
#include <random>

#include "tests/recording/store/samples.h"

namespace imunoise::recording {
namespace {

// Host and device times of samples at 100 Hz, `ppm` fast; late by at least 2 ms, often more.
class Way {
 public:
  Way(double ppm, unsigned seed) : ppm_(ppm), engine_(seed) {}

  void send(std::size_t samples, DeviceClock& to) {
    for (std::size_t i = 0; i < samples; ++i, ++sent_) {
      const double device_s = static_cast<double>(sent_) * 0.01;
      const double host_s = device_s / (1.0 + 1e-6 * ppm_) + 2e-3 + late_(engine_);
      const std::int64_t host = kStart + std::llround(host_s * 1e9);
      const std::int64_t device = 5'000 + std::llround(device_s * 1e9);
      to.take({&host, 1}, {&device, 1});
    }
  }

 private:
  double ppm_;
  std::mt19937_64 engine_;
  std::exponential_distribution<double> late_{1000.0};  // of 1 ms
  std::size_t sent_ = 0;
};

TEST(DeviceClock, FindsRateStartAndJitter) {
  int covered = 0;
  constexpr int kTrials = 200;
  for (unsigned seed = 0; seed < kTrials; ++seed) {
    DeviceClock clock;
    Way(37.0, seed).send(60'000, clock);  // ten minutes
    const auto found = clock.comparison();
    ASSERT_TRUE(found);
    covered += found->ppm_lower() <= 37.0 && 37.0 <= found->ppm_upper() ? 1 : 0;
    // The earliest of a hundred delays of 1 ms scatters by 10 µs; over 600 s that is 0.002 ppm.
    EXPECT_NEAR(found->ppm(), 37.0, 0.02);
    EXPECT_LT(found->ppm_upper() - found->ppm_lower(), 0.02);
    EXPECT_NEAR(static_cast<double>(found->first_sample_ns() - kStart), 2e6, 0.05e6);
    EXPECT_NEAR(found->jitter_s(), 1e-3, 0.05e-3);
    EXPECT_NEAR(found->seconds(), 600.0, 1.0);
  }
  // Binomial, 95 % of 200: 190 ± 3.1; five standard deviations.
  EXPECT_GE(covered, 174);
}

TEST(DeviceClock, TheLongestStretchCountsWhereTheClockBeginsAnew) {
  DeviceClock clock;
  EXPECT_FALSE(clock.comparison());
  Way(10.0, 1).send(2'000, clock);
  clock.restart();
  Way(20.0, 2).send(9'000, clock);
  clock.restart();
  Way(30.0, 3).send(3'000, clock);
  const auto found = clock.comparison();
  ASSERT_TRUE(found);
  EXPECT_NEAR(found->ppm(), 20.0, 0.5);
  EXPECT_NEAR(found->seconds(), 89.0, 1.0);
}

TEST(DeviceClock, ShortStretchesSayNothing) {
  DeviceClock clock;
  Way(10.0, 1).send(900, clock);
  EXPECT_FALSE(clock.comparison());
}

}  // namespace
}  // namespace imunoise::recording
