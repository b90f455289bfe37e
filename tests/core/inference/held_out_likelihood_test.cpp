#include "core/inference/held_out_likelihood.h"

#include <gtest/gtest.h>

#include "core/estimate/estimators.h"
#include "core/spectrum/banded_power.h"
#include "tests/core/inference/simulated_sets.h"

namespace imunoise {
namespace {

constexpr std::uint64_t kHeldOutSeed = 31;

std::vector<BandedPower> powers_of(const Model& truth, std::uint32_t replicates) {
  std::vector<BandedPower> out;
  for (std::uint32_t k = 0; k < replicates; ++k) {
    const std::vector<double> x = simulate(truth, 8192, kHeldOutSeed, k);
    out.push_back(banded_power(Signal(std::span<const double>(x), testing::kTrialRate)));
  }
  return out;
}

HeldOutFit held(const char* model, const std::vector<BandedPower>& parts) {
  return held_out_fit(testing::model_of(model), parts);
}

// The parts of one replicate are its bands, each once: likelihoods add up.
TEST(HeldOutLikelihood, DealtOutBandsAreTheWhole) {
  const Model truth = testing::model_of("WN(sigma2=1) + RW(gamma2=1e-4)");
  const std::vector<BandedPower> whole = powers_of(truth, 1);
  const std::vector<BandedPower> parts = dealt_out(whole[0], 5);
  ASSERT_EQ(parts.size(), 5U);
  EXPECT_NEAR(whittle_objective(truth, parts), whittle_objective(truth, whole),
              1e-9 * std::abs(whittle_objective(truth, whole)));
  EXPECT_EQ(parts[1].frequency(0), whole[0].frequency(1));
  EXPECT_EQ(parts[1].frequency(1), whole[0].frequency(6));
}

// What a replicate says is held out of the fit that predicts it: a fit to all predicts it better.
TEST(HeldOutLikelihood, ThePartThatIsPredictedIsNotFitted) {
  const auto parts = powers_of(testing::model_of("WN(sigma2=1) + RW(gamma2=1e-4)"), 3);
  const HeldOutFit fit = held("WN(sigma2=1) + RW(gamma2=1e-4)", parts);
  EXPECT_EQ(fit.nats.size(), 3U);
  const HeldOutFit free =
      held_out_fit(testing::freed(testing::model_of("WN(sigma2=1) + RW(gamma2=1e-4)")), parts);
  EXPECT_LT(free.total(), -whittle_objective(free.model, parts));
  EXPECT_NEAR(fit.total(), -whittle_objective(fit.model, parts), 1e-9 * std::abs(fit.total()));
}

TEST(HeldOutLikelihood, TheWalkIsKeptWhereThereIsOneAndTheSimplestElse) {
  const std::vector<Model> models = {testing::freed(testing::model_of("WN(sigma2=1)")),
                                     testing::freed(testing::model_of("WN(sigma2=1) + "
                                                                      "RW(gamma2=1e-6)"))};
  for (const bool there : {true, false}) {
    const auto parts =
        powers_of(testing::model_of(there ? "WN(sigma2=1) + RW(gamma2=1e-5)" : "WN(sigma2=1)"), 4);
    for (const auto& given : {parts, dealt_out(parts[0], 6)}) {
      std::vector<HeldOutFit> fits;
      for (const Model& model : models) fits.push_back(held_out_fit(model, given));
      EXPECT_EQ(simplest_of_best(fits), there ? 1U : 0U) << given.size();
    }
  }
}

}  // namespace
}  // namespace imunoise
