// Noise of a model inside an emulated sensor, its quantisation included, against theory.

#include <cmath>

#include "core/wavelet/wavelet_variance.h"
#include "drivers/emulator/sensors/adis16405.h"
#include "tests/drivers/emulator/still_source.h"

namespace imunoise::testing {
namespace {

using namespace std::chrono_literals;
using emulator::SourceTexts;

constexpr double kStep = 0.05 * 3.14159265358979323846 / 180.0;  // rad/s of a count

// Counts of the gyroscopes of an ADIS16405 that is left alone for so long.
std::array<std::vector<double>, 3> gyro_counts(const SourceTexts& texts,
                                               std::chrono::seconds time) {
  const auto source = make_source(texts);
  emulator::Adis16405 sensor(*source, 1);
  sensor.data_ready(time);
  std::array<std::vector<double>, 3> out;
  for (const emulator::TakenSample& sample : sensor.taken()) {
    for (std::size_t axis = 0; axis < 3; ++axis) out[axis].push_back(sample.counts[1 + axis]);
  }
  return out;
}

// ν of the counts is the model's and that of the rounding, Δ²/12 and white. Limits: five
// standard deviations of a χ² with n/2m degrees of freedom, which the estimate has at least.
TEST(ModelledSource, AnEmulatedSensorHasTheWaveletVarianceOfItsModel) {
  const Hertz rate{819.2};
  const std::string text = "WN(sigma2=4e-6) + AR1(sigma2=4e-9, phi=0.99)";
  const auto counts = gyro_counts({.models = {text}, .seed = 3, .rate = rate}, 240s);
  ASSERT_GT(counts[0].size(), 196'000U);
  const Model model = *parse_model(text, rate);
  const Scales scales({1, 4, 16, 64, 256});
  for (const auto& axis : counts) {
    const Signal signal(std::span<const double>(axis), rate, Quantity::kAngularRate, kStep, 0.0);
    const WaveletVariance measured = wavelet_variance(signal, scales);
    const Eigen::ArrayXd m = scales.half_widths();
    const Eigen::ArrayXd expected = variance(model, m) + kStep * kStep / 12.0 / (2.0 * m);
    for (Eigen::Index i = 0; i < m.size(); ++i) {
      const double limit = 5.0 * std::sqrt(4.0 * m[i] / static_cast<double>(axis.size()));
      EXPECT_NEAR(measured.variance[i] / expected[i], 1.0, limit) << m[i];
    }
  }
}

TEST(ModelledSource, TheSameSeedGivesTheSameCountsAndAnotherOthers) {
  const SourceTexts texts = {.effects = {"telegraph(height=0.01, dwell=1)"}, .seed = 9};
  SourceTexts other = texts;
  other.seed = 10;
  const auto counts = gyro_counts(texts, 10s);
  EXPECT_EQ(gyro_counts(texts, 10s), counts);
  EXPECT_NE(gyro_counts(other, 10s)[0], counts[0]);
  EXPECT_NE(counts[0], counts[1]) << "axes share no noise";
}

TEST(ModelledSource, AnEffectLeavesTheNoiseAsItIs) {
  const std::string noise = "gyro: WN(sigma2=1) + RW(gamma2=0.01)";
  const auto plain = make_source({.models = {noise}, .seed = 4});
  const auto stepped = make_source(
      {.models = {noise}, .effects = {"step(at=0.5, height=8, channel=gyro_x)"}, .seed = 4});
  for (int i = 0; i < 100; ++i) {
    const auto a = plain->measure(0.01 * i);
    const auto b = stepped->measure(0.01 * i);
    EXPECT_NEAR(b.rate[0] - a.rate[0], i < 50 ? 0.0 : 8.0, 1e-12);
    EXPECT_EQ(b.rate[1], a.rate[1]);
  }
}

TEST(ModelledSource, ALaterModelOfAnAxisReplacesTheEarlierOne) {
  const auto source =
      make_source({.models = {"gyro: WN(sigma2=1)", "gyro_y: DR(omega2=0.25)"}, .seed = 4});
  source->measure(0.0);
  const auto sample = source->measure(0.01);
  EXPECT_EQ(sample.rate[1], 0.5);
  EXPECT_NE(sample.rate[2], 0.5);
  EXPECT_EQ(sample.specific_force[0], 0.0) << "no model, no noise";
}

TEST(ModelledSource, SaysWhatItCannotRead) {
  const auto refused = [](const std::string& text, const std::string& words) {
    const auto source = emulator::ModelledSource::make({.models = {text}});
    ASSERT_FALSE(source) << text;
    EXPECT_NE(source.error().message.find(words), std::string::npos) << source.error().message;
  };
  refused("gyro: WN", "leaves values open");
  refused("nose: WN(sigma2=1)", "no quantity 'nose'");
  refused("gyro: PINK(b=1)", "unknown process 'PINK'");
  refused("gyro: WN(sigma2=1) + line(f=5)", "unknown process 'line'");
  refused("gyro: WN(sigma2=1) + line(f=5)", "give each apart, such as --effect");
}

}  // namespace
}  // namespace imunoise::testing
