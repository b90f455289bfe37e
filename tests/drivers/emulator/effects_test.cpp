// Effects against what their formulas say. Seeds are fixed; limits are five standard deviations.

#include <cmath>
#include <complex>
#include <numbers>

#include "tests/drivers/emulator/still_source.h"

namespace imunoise::testing {
namespace {

// Amplitude and phase of the line at `frequency`: 2/n Σ x_i exp(-2πi·frequency·t_i).
std::complex<double> line(const std::vector<double>& samples, double frequency, double rate) {
  std::complex<double> sum = 0.0;
  for (std::size_t i = 0; i < samples.size(); ++i) {
    const double phase = 2.0 * std::numbers::pi * frequency * static_cast<double>(i) / rate;
    sum += samples[i] * std::polar(1.0, -phase);
  }
  return 2.0 * sum / static_cast<double>(samples.size());
}

double mean_product(const std::vector<double>& samples, std::size_t lag) {
  double sum = 0.0;
  for (std::size_t i = lag; i < samples.size(); ++i) sum += samples[i] * samples[i - lag];
  return sum / static_cast<double>(samples.size() - lag);
}

TEST(Effects, AFanHasItsLineAndItsHarmonics) {
  const auto source = silent_source({"fan(frequency=7, amplitude=0.6, harmonics=3)"});
  const auto samples = take_gyro_x(*source, 1000, 100.0);
  EXPECT_NEAR(std::abs(line(samples, 7.0, 100.0)), 0.6, 1e-9);
  EXPECT_NEAR(std::abs(line(samples, 14.0, 100.0)), 0.3, 1e-9);
  EXPECT_NEAR(std::abs(line(samples, 21.0, 100.0)), 0.2, 1e-9);
  EXPECT_NEAR(std::abs(line(samples, 28.0, 100.0)), 0.0, 1e-9);
}

TEST(Effects, TheMainsAreFolded) {
  const auto source = silent_source({"mains(amplitude=0.25)"});
  const auto samples = take_gyro_x(*source, 4000, 40.0);
  EXPECT_NEAR(std::abs(line(samples, 10.0, 40.0)), 0.25, 1e-9);  // |50 - 40| Hz
}

TEST(Effects, TemperatureIsSeenAndFollowedLate) {
  // ωL = 1: 1/√2 of the swing, 45° late. The first 20 time constants are left to settle.
  const double lag = 100.0 / (2.0 * std::numbers::pi);
  const auto source =
      silent_source({"temperature(swing=2, period=100, coupling=0.01, lag=" + std::to_string(lag) +
                     ", channel=gyro_x)"});
  std::vector<double> rate;
  std::vector<double> temperature;
  for (int i = 0; i < 20'000; ++i) {
    const auto sample = source->measure(0.05 * i);
    if (i < 10'000) continue;
    rate.push_back(sample.rate[0]);
    temperature.push_back(sample.temperature);
    ASSERT_EQ(sample.rate[1], 0.0);
  }
  const auto cause = line(temperature, 0.01, 20.0);
  const auto answer = line(rate, 0.01, 20.0);
  EXPECT_NEAR(std::abs(cause), 2.0, 1e-6);
  EXPECT_NEAR(std::abs(answer), 0.02 / std::numbers::sqrt2, 5e-5);
  EXPECT_NEAR(std::arg(answer / cause), -std::numbers::pi / 4.0, 5e-3);
}

TEST(Effects, TemperatureDriftsAndMayActSquared) {
  const auto source = silent_source({"temperature(drift=3600, coupling=0.1, quadratic=0.01)"});
  source->measure(0.0);
  const auto sample = source->measure(4.0);  // a kelvin a second
  EXPECT_NEAR(sample.temperature - emulator::at_rest().temperature, 4.0, 1e-9);
  EXPECT_NEAR(sample.rate[2], 0.4 + 0.16, 1e-9);
}

TEST(Effects, TheSupplyIsAWitnessToo) {
  const auto source = silent_source({"supply(drift=3600, coupling=-0.5, channel=acc_y)"});
  source->measure(0.0);
  const auto sample = source->measure(0.1);
  EXPECT_NEAR(sample.supply, 5.1, 1e-9);
  EXPECT_NEAR(sample.specific_force[1], -0.05, 1e-9);
}

TEST(Effects, AStepIsThereFromItsMomentOn) {
  const auto source = silent_source({"step(at=1, height=-0.5, channel=gyro_x)"});
  const auto samples = take_gyro_x(*source, 20, 10.0);
  for (std::size_t i = 0; i < samples.size(); ++i) EXPECT_EQ(samples[i], i < 10 ? 0.0 : -0.5);
}

// A correlation time of 25 samples: 100'000 samples are 2000 independent ones and more.
TEST(Effects, TelegraphNoiseHasTwoLevelsAndItsDwell) {
  const auto source = silent_source({"telegraph(height=0.2, dwell=0.5)"}, 11);
  const auto samples = take_gyro_x(*source, 100'000, 100.0);
  double mean = 0.0;
  std::size_t jumps = 0;
  for (std::size_t i = 0; i < samples.size(); ++i) {
    ASSERT_EQ(std::abs(samples[i]), 0.1);
    mean += samples[i] / static_cast<double>(samples.size());
    if (i > 0 && samples[i] != samples[i - 1]) ++jumps;
  }
  EXPECT_NEAR(mean, 0.0, 5.0 * 0.1 / std::sqrt(2000.0));
  EXPECT_NEAR(mean_product(samples, 25) / 0.01, std::exp(-1.0), 5.0 / std::sqrt(2000.0));
  const double expected = 1e5 * 0.5 * (1.0 - std::exp(-0.04));  // an odd number of jumps in 10 ms
  EXPECT_NEAR(static_cast<double>(jumps), expected, 5.0 * std::sqrt(expected));
}

TEST(Effects, AxesHaveTelegraphsOfTheirOwn) {
  const auto source = silent_source({"telegraph(height=0.2, dwell=0.1)"}, 11);
  double product = 0.0;
  for (int i = 0; i < 100'000; ++i) {
    const auto sample = source->measure(0.1 * i);
    product += sample.rate[0] * sample.rate[1] / 0.01 / 1e5;
  }
  EXPECT_NEAR(product, 0.0, 5.0 * std::sqrt(1.3 / 1e5));
}

TEST(Effects, OutliersAreAShareOfHeavyOnes) {
  const auto source = silent_source({"outliers(share=0.01, deviation=3)"}, 5);
  const auto samples = take_gyro_x(*source, 200'000, 100.0);
  std::size_t count = 0;
  double power = 0.0;
  for (const double x : samples) {
    count += x != 0.0 ? 1U : 0U;
    power += x * x;
  }
  EXPECT_NEAR(static_cast<double>(count), 2000.0, 5.0 * std::sqrt(2000.0));
  EXPECT_NEAR(power / static_cast<double>(count), 9.0, 5.0 * 9.0 * std::sqrt(2.0 / 2000.0));
}

TEST(Effects, WarmingUpBeginsAnewWithPowerButTheSurroundingsGoOn) {
  const auto source =
      silent_source({"warm_up(size=1, time=10, channel=gyro_x)",
                     "step(at=15, height=5, channel=gyro_y)", "temperature(drift=3600)"});
  EXPECT_NEAR(source->measure(0.0).rate[0], 1.0, 1e-12);
  const auto warm = source->measure(10.0);
  EXPECT_NEAR(warm.rate[0], std::exp(-1.0), 1e-12);
  EXPECT_EQ(warm.rate[1], 0.0);
  const auto again = source->measure(6.0);  // power failed at 10 s
  EXPECT_NEAR(again.rate[0], std::exp(-0.6), 1e-12);
  EXPECT_EQ(again.rate[1], 5.0);  // 16 s in all
  EXPECT_NEAR(again.temperature, emulator::at_rest().temperature + 16.0, 1e-9);
}

TEST(Effects, OutputsSaturateAndStickWithNoiseAndAll) {
  const auto source = make_source({.models = {"gyro: WN(sigma2=1)"},
                                   .effects = {"stuck(at=1, for=0.5, channel=gyro_x)",
                                               "saturation(limit=0.7, channel=gyro_y)"}});
  double before = 0.0;
  int at_limit = 0;
  for (int i = 0; i < 200; ++i) {
    const auto sample = source->measure(0.01 * i);
    EXPECT_EQ(sample.rate[0] == before, i >= 100 && i < 150) << i;
    before = sample.rate[0];
    EXPECT_LE(std::abs(sample.rate[1]), 0.7);
    at_limit += std::abs(sample.rate[1]) == 0.7 ? 1 : 0;
  }
  EXPECT_NEAR(at_limit, 200 * 0.484, 5.0 * std::sqrt(200 * 0.484 * 0.516));  // P(|N(0, 1)| > 0.7)
}

TEST(Effects, SayWhatTheyCannotBe) {
  const auto refused = [](const std::string& text, const std::string& words) {
    const auto source = emulator::ModelledSource::make({.effects = {text}});
    ASSERT_FALSE(source) << text;
    EXPECT_NE(source.error().message.find(words), std::string::npos) << source.error().message;
  };
  refused("wind(speed=3)", "no effect 'wind'; there are temperature");
  refused("step(at=1)", "height is missing; write step(at s, height)");
  refused("step(at=1, height=x)", "height=x is not a number");
  refused("step(at=-1, height=1)", "at=-1 is not a number from 0");
  refused("step(at=1, height=nan)", "height=nan");
  refused("step(at=1, at=2, height=1)", "at is given twice");
  refused("step(at=1, height=1, colour=2)", "has no 'colour'");
  refused("step(at=1, height=1, channel=nose)", "step: no quantity 'nose'");
  refused("step(at=1", "no ')'");
}

}  // namespace
}  // namespace imunoise::testing
