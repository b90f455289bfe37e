// A witness that is a signal and noise of its own: an effect follows the signal.

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <optional>

#include "core/effect/witness_spectrum.h"
#include "core/effects/known_effects.h"
#include "core/effects/parse_full_model.h"
#include "core/search/search_view.h"
#include "tests/core/diagnosis/subject_of.h"

namespace imunoise {
namespace {

constexpr double kMotionRate = 50.0;
constexpr std::size_t kMotionSamples = 16'384;
constexpr double kFollowed = 0.4;

// Motion of a standard deviation of 1 about 5 Hz, and a witness with white noise beside it.
struct NoisyMotion {
  std::vector<std::vector<double>> motion;
  std::shared_ptr<const Subject> subject;
};

NoisyMotion noisy(double noise, std::uint64_t seed) {
  NoisyMotion out;
  const Model moves = *parse_model("AR2(sigma2=0.0717, rho1=0.789, phi2=-0.9)", Hertz{kMotionRate});
  const Model white = *parse_model("WN(sigma2=1)", Hertz{kMotionRate});
  std::vector<std::vector<double>> own;
  for (std::uint32_t k = 0; k < 4; ++k) {
    out.motion.push_back(simulate(moves, kMotionSamples, seed + 1, k));
    own.push_back(simulate(white, kMotionSamples, seed + 2, k));
  }
  const auto at = [](double s) { return static_cast<std::size_t>(std::lround(s * kMotionRate)); };
  out.subject = subject_of(
      {.model = "WN(sigma2=1)",
       .samples = kMotionSamples,
       .seed = seed,
       .added = [&](std::size_t k, double s) { return kFollowed * out.motion[k][at(s)]; },
       .temperature = [&](std::size_t k,
                          double s) { return out.motion[k][at(s)] + noise * own[k][at(s)]; },
       .witness = Quantity::kAcceleration});
  return out;
}

// The density of the witness's own noise that the search suggests; none where it helps nothing.
std::optional<EffectTerm> with_noise(const FittedModel& plain) {
  const Current current = current_of(plain.regression, plain.fit);
  const Effect& effect = effect_named("witness");
  const auto of_noise = [](const EffectParameter& one) { return one.name == "noise"; };
  const auto place = static_cast<std::size_t>(
      std::find_if(effect.parameters.begin(), effect.parameters.end(), of_noise) -
      effect.parameters.begin());
  for (const Suggestion& one : effect.search(SearchView(current))) {
    const auto& term = std::get<EffectTerm>(one.added);
    if (term.given(place)) return term;
  }
  return std::nullopt;
}

// The share of the signal is 1 where there is no noise, and 0 where there is nothing else.
TEST(WitnessSpectrum, TellsSignalFromNoise) {
  const NoisyMotion one = noisy(0.5, 40);
  const WitnessSpectrum spectrum(one.subject->witnesses[0].cosines);
  const Eigen::ArrayXd share = spectrum.signal(0.25);
  EXPECT_LT(share.tail(16).maxCoeff(), 0.2);  // 18 to 25 Hz
  EXPECT_GT(share.maxCoeff(), 0.9);
  EXPECT_TRUE((spectrum.signal(0.0) == (spectrum.power() > 0.0).cast<double>()).all());
  // Bands cover all coefficients.
  const std::vector<Eigen::Index> edges = spectrum.edges(kMotionSamples);
  EXPECT_EQ(edges.front(), 0);
  EXPECT_EQ(edges.back(), static_cast<Eigen::Index>(kMotionSamples) - 1);
  EXPECT_TRUE(std::is_sorted(edges.begin(), edges.end()));
}

// What is left is the signal but for what noise hides: uncorrelated with its error.
TEST(WitnessSpectrum, LeavesTheExpectedSignal) {
  const NoisyMotion one = noisy(0.5, 50);
  const Witness left = without_noise(one.subject->witnesses[0], 0.25);
  double product = 0.0;
  double square = 0.0;
  for (std::size_t k = 0; k < 4; ++k) {
    const Eigen::Map<const Eigen::VectorXd> motion(one.motion[k].data(), kMotionSamples);
    product += left.samples[k].dot(motion);
    square += left.samples[k].squaredNorm();
  }
  EXPECT_NEAR(product / square, 1.0, 0.02);
}

TEST(NoisyWitness, CoefficientsAreUnbiased) {
  constexpr int kMotions = 12;
  double squares = 0.0;
  for (int set = 0; set < kMotions; ++set) {
    const NoisyMotion one = noisy(0.5, 1'000 + 10 * static_cast<std::uint64_t>(set));
    const FittedModel plain = fitted(one.subject, "WN");
    const auto term = with_noise(plain);
    ASSERT_TRUE(term) << "set " << set;
    const FittedModel both = fit_with(current_of(plain.regression, plain.fit), *term);
    const ReportedNumber found = fitted_numbers({both, 0}).at(0);
    const double error = (*found.upper - *found.lower) / (2.0 * interval_reach());
    const double z = (found.value - kFollowed) / error;
    squares += z * z;
  }
  std::printf("sum of squares %.1f for %d\n", squares, kMotions);
  EXPECT_LT(squares, 32.9);  // χ² of 12, once in a thousand
}

TEST(NoisyWitness, ACleanOneHasNone) {
  for (const std::uint64_t seed : {2'000U, 2'010U, 2'020U})
    EXPECT_FALSE(with_noise(fitted(noisy(0.0, seed).subject, "WN"))) << "seed " << seed;
}

}  // namespace
}  // namespace imunoise
