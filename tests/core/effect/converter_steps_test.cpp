// Noise that a converter rounded: how many steps it has, and what rounding does to its tails.

#include "core/effect/converter_steps.h"

#include <gtest/gtest.h>

#include <cmath>

#include "core/diagnosis/views/misfit.h"
#include "tests/core/diagnosis/subject_of.h"

namespace imunoise {
namespace {

// White noise of so many steps, rounded.
std::shared_ptr<const Subject> rounded_noise(double deviation, std::size_t samples) {
  constexpr std::uint64_t kSeed = 51;
  const MadeSubject made{.model = "WN(sigma2=1)", .samples = samples, .seed = kSeed};
  auto out = std::make_shared<Subject>(*subject_of(made));
  for (std::size_t k = 0; k < out->replicates(); ++k) {
    Eigen::VectorXd x = (deviation * out->samples[k].array() + 0.3).round();
    x.array() -= x.mean();
    out->cosines[k] = cosine_transform(x);
    out->samples[k] = std::move(x);
  }
  return out;
}

TEST(ConverterSteps, AreSeenWithTheNoiseThatHidesThem) {
  for (const double deviation : {0.3, 0.7, 1.5}) {
    const ConverterSteps steps = converter_steps(*rounded_noise(deviation, 8192));
    EXPECT_NEAR(steps.step, 1.0, 1e-9);
    EXPECT_NEAR(steps.noise, deviation, 0.05) << "chance: 1 %; at 0.3 steps, of the mean too";
    EXPECT_EQ(steps.is_coarse(), deviation < 0.75);
  }
  EXPECT_FALSE(converter_steps(*subject_of({.samples = 8192})).is_coarse());
}

// Fourth cumulants add: rounding's is -1/120 of a step⁴.
TEST(ConverterSteps, LightTailsOfRoundingAreExpected) {
  constexpr std::size_t kSamples = std::size_t{1} << 20;
  const auto subject = rounded_noise(0.8, kSamples);
  const FittedModel model = fitted(subject, "WN");
  const ConverterSteps steps = converter_steps(*subject);
  const double error = std::sqrt(24.0 / (4.0 * kSamples));
  EXPECT_LT(steps.excess_kurtosis(innovation_deviation(model.fit.model.noise)), -6.0 * error)
      << "else nothing is tested";
  EXPECT_LT(std::abs(misfit_of(model).excess_kurtosis.value()), 3.9 * error);
  EXPECT_FALSE(misfit_of(fitted(rounded_noise(0.5, 8192), "WN")).excess_kurtosis);
}

}  // namespace
}  // namespace imunoise
