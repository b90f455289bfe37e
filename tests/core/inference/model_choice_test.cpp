#include "core/inference/model_choice.h"

#include <gtest/gtest.h>

#include <set>

#include "tests/core/inference/simulated_sets.h"

namespace imunoise {
namespace {

constexpr std::uint64_t kChoiceSeed = 12;

TEST(SubModels, AreEveryChoiceOfTermsOnce) {
  const std::vector<Model> all = sub_models(testing::model_of("2*AR1 + WN + RW"));
  std::set<std::string> names;
  for (const Model& model : all) names.insert(print(model));
  EXPECT_EQ(all.size(), 11U);
  EXPECT_EQ(names.size(), all.size());
  EXPECT_TRUE(names.contains("2*AR1 + WN + RW"));
  EXPECT_TRUE(names.contains("AR1 + RW"));
  EXPECT_FALSE(names.contains(""));
}

class Ways : public ::testing::TestWithParam<ChoiceOptions> {};

TEST_P(Ways, FindTheTruthAndRefuseWhatLacksAProcess) {
  const Model truth = testing::model_of("AR1(sigma2=0.05, phi=0.98) + WN(sigma2=1)");
  const auto moments =
      testing::simulated_set(truth, std::vector<std::size_t>(6, 20'000), 1, kChoiceSeed);
  const ModelChoice choice =
      choose_model(sub_models(testing::model_of("AR1 + WN + RW")), moments, GetParam());
  EXPECT_EQ(choice.splits, GetParam().splits == Splits::kHalf ? 20U : 6U);
  ASSERT_EQ(choice.candidates.size(), 7U);
  double before = 0.0;
  for (const Candidate& candidate : choice.candidates) {
    std::set<std::string_view> names;
    for (const Term& term : candidate.model.terms) names.insert(info(term.process).name);
    const bool enough = names.contains("AR1") && names.contains("WN");
    EXPECT_EQ(candidate.verdict != ChoiceVerdict::kNotAppropriate, enough)
        << print(candidate.model);
    if (enough) {
      // A mean of 6 sums of about 11 squares: 1 within 3.3 of its standard errors √(2/66).
      EXPECT_NEAR(candidate.merit.value, 1.0, 0.6) << print(candidate.model);
    } else {
      EXPECT_GT(candidate.merit.value, 2.0) << print(candidate.model);
    }
    EXPECT_GE(candidate.merit.value, before - 1e-6);
    EXPECT_GE(candidate.merit.upper, candidate.merit.value);
    before = candidate.merit.value;
  }
}

INSTANTIATE_TEST_SUITE_P(All, Ways,
                         ::testing::Values(ChoiceOptions{Splits::kLeaveOneOut, Weighting::kFull},
                                           ChoiceOptions{Splits::kHalf, Weighting::kFull},
                                           ChoiceOptions{Splits::kHalf, Weighting::kDiagonal}));

// A term that the fit puts at zero changes nothing: the smaller model stands first.
TEST(ModelChoice, OfEqualsTheSmallestComesFirst) {
  const Model truth = testing::model_of("WN(sigma2=1)");
  const std::vector<WaveletVariance> moments(4, testing::theory(truth, 4096));
  const ModelChoice choice = choose_model(sub_models(testing::model_of("WN + RW + QN")), moments);
  EXPECT_EQ(print(testing::freed(choice.candidates[0].model)), "WN");
  EXPECT_NEAR(choice.candidates[0].merit.value, 0.0, 1e-2);  // no noise at all: below any floor
}

// Those that differ by rounding alone do not differ: chance must not make one of them worse.
TEST(ModelChoice, RoundingIsNoDifference) {
  const Model truth = testing::model_of("AR1(sigma2=0.05, phi=0.98) + WN(sigma2=1)");
  const auto moments = testing::simulated_set(truth, std::vector<std::size_t>(4, 8192), 1, 3);
  const ModelChoice choice = choose_model(sub_models(testing::model_of("AR1 + WN + RW")), moments);
  const Candidate& second = choice.candidates[1];
  ASSERT_EQ(second.model.terms.size(), 3U);
  ASSERT_EQ(values(second.model.terms[2].process)[0], 0.0);  // no random walk was found
  EXPECT_EQ(second.excess.value, 0.0);
  EXPECT_EQ(second.excess.upper, 0.0);
  EXPECT_EQ(second.verdict, ChoiceVerdict::kEquivalent);
}

}  // namespace
}  // namespace imunoise
