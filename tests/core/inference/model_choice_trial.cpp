// Cross-validated model choice: coverage of the intervals of its differences, and what it selects.

#include <gtest/gtest.h>

#include <algorithm>
#include <cstdio>
#include <vector>

#include "core/inference/held_out_likelihood.h"
#include "core/inference/model_choice.h"
#include "core/support/linear_algebra.h"
#include "core/support/parallel.h"
#include "tests/core/inference/simulated_sets.h"

namespace imunoise {
namespace {

constexpr std::uint64_t kSeed = 20261121;
constexpr std::size_t kSets = 300;

// What a model is expected to be off by on a new replicate of the truth, over its noise floor: from
// the truth, not from data.
double expected_excess(const Model& fitted, const Model& truth, const NormalScores& scores,
                       const WaveletVariance& like) {
  const Eigen::ArrayXd m = like.scales.half_widths();
  return scores.shift(variance(fitted, m), variance(truth, m)).squaredNorm() /
         static_cast<double>(scores.size());
}

// The models that a way of splitting is about: fitted to each training set by a search of its own,
// with the weights of the truth.
std::vector<Model> trained(const Model& open, const std::vector<WaveletVariance>& moments,
                           const Eigen::MatrixXd& root, Splits splits) {
  const std::size_t held = splits == Splits::kLeaveOneOut ? 1 : moments.size() / 2;
  std::vector<bool> out(moments.size(), false);
  std::fill(out.begin(), out.begin() + static_cast<std::ptrdiff_t>(held), true);
  std::vector<Model> models;
  do {
    std::vector<WaveletVariance> training;
    for (std::size_t k = 0; k < moments.size(); ++k) {
      if (!out[k]) training.push_back(moments[k]);
    }
    const std::vector<Eigen::MatrixXd> roots(training.size(), root);
    models.push_back(sorted(minimise(tied_problem(open, training, roots)).model));
  } while (std::prev_permutation(out.begin(), out.end()));
  return models;
}

class Coverage : public ::testing::TestWithParam<Splits> {};

// The interval of the difference between two models covers what the difference on new replicates
// will be. Two pairs: one model lacks a term, the other has one too many.
TEST_P(Coverage, OfTheDifference) {
  const Model truth = testing::model_of("AR1(sigma2=2e-3, phi=0.97) + WN(sigma2=1)");
  const Model right = testing::model_of("AR1 + WN");
  const std::vector<std::size_t> lengths(6, 8192);
  const WaveletVariance like = testing::theory(truth, lengths[0]);
  const std::vector<WaveletVariance> one = {like};
  const Eigen::MatrixXd covariance = moment_covariances(truth, one)[0];
  const Eigen::MatrixXd root = whiten(covariance).matrix;
  const NormalScores scores(truth, like, covariance);
  for (const char* text : {"WN + RW", "AR1 + WN + RW"}) {
    const Model other = testing::model_of(text);
    std::vector<int> covered(kSets);
    std::vector<int> right_first(kSets);
    for_each_index(kSets, [&](std::size_t i) {
      const auto moments = testing::simulated_set(truth, lengths, 1, kSeed + i);
      const std::vector<Model> pair = {right, other};
      const ModelChoice choice = choose_model(pair, moments, {GetParam(), Weighting::kFull});
      right_first[i] = choice.candidates[0].model.terms.size() == 2 &&
                       info(choice.candidates[0].model.terms[0].process).name == "AR1";
      double expected = 0.0;
      for (const bool first : {true, false}) {
        const auto models = trained(first ? right : other, moments, root, GetParam());
        const double sign = first == (right_first[i] == 1) ? -1.0 : 1.0;
        for (const Model& model : models) {
          expected += sign * expected_excess(model, truth, scores, like) /
                      static_cast<double>(models.size());
        }
      }
      const Interval& excess = choice.candidates[1].excess;
      constexpr double kRounding = 1e-6;  // of a difference between models that are the same
      covered[i] = excess.lower - kRounding <= expected && expected <= excess.upper + kRounding;
    });
    const auto share = [](const std::vector<int>& all) {
      double sum = 0.0;
      for (const int at : all) sum += at;
      return sum / static_cast<double>(all.size());
    };
    std::printf(
        "%s, %s against the truth: covered %.1f %%, truth selected in %.1f %% of %zu sets\n",
        GetParam() == Splits::kHalf ? "half splits" : "leave one out", text, 100.0 * share(covered),
        100.0 * share(right_first), kSets);
    EXPECT_GT(share(covered), 0.95 - testing::binomial_allowance(0.95, kSets));
  }
}

bool has_walk(const Model& model) {
  return std::any_of(model.terms.begin(), model.terms.end(), [](const Term& term) {
    return std::holds_alternative<RandomWalk>(term.process);
  });
}

struct Kept {
  int by_error = 0;       // CV-WVIC, the simplest model that is not worse
  int by_likelihood = 0;  // held-out likelihood over replicates
  int by_one = 0;         // the same of the first replicate alone, its bands dealt out
  int by_fit = 0;         // the interval of the whole model's fit does not reach zero
};

// In how many sets each criterion keeps a random walk.
Kept walks_kept(const Model& truth, std::size_t sets) {
  const std::vector<Model> all = sub_models(testing::model_of("2*AR1 + WN + RW"));
  std::vector<Kept> each(sets);
  for_each_index(sets, [&](std::size_t i) {
    std::vector<WaveletVariance> moments;
    std::vector<BandedPower> powers;
    for (std::uint32_t k = 0; k < 6; ++k) {
      const std::vector<double> x = simulate(truth, 30'000, kSeed + i, k);
      const Signal signal(std::span<const double>(x), testing::kTrialRate);
      moments.push_back(wavelet_variance(signal, Scales::for_samples(x.size(), 1)));
      powers.push_back(banded_power(signal));
    }
    std::vector<Estimate> fits;
    std::vector<HeldOutFit> held;
    std::vector<HeldOutFit> one;
    const std::vector<BandedPower> dealt = dealt_out(powers[0], 6);
    for (const Model& model : all) {
      fits.push_back(mugmwm(model, moments, Weighting::kFull));
      held.push_back(held_out_fit(fits.back().model, powers));
      one.push_back(held_out_fit(fits.back().model, dealt));
    }
    const ModelChoice choice = choose_model(fits, moments, {});
    const Candidate* simplest = &choice.candidates[0];
    for (const Candidate& candidate : choice.candidates) {
      if (candidate.verdict == ChoiceVerdict::kEquivalent &&
          parameter_count(candidate.model) < parameter_count(simplest->model))
        simplest = &candidate;
    }
    each[i].by_error = has_walk(simplest->model) ? 1 : 0;
    each[i].by_likelihood = has_walk(held[simplest_of_best(held)].model) ? 1 : 0;
    each[i].by_one = has_walk(one[simplest_of_best(one)].model) ? 1 : 0;
    const Fit whole =
        infer(mugmwm(testing::model_of("AR1 + WN + RW"), moments, Weighting::kFull), moments);
    for (std::size_t t = 0; t < whole.estimate.model.terms.size(); ++t) {
      if (std::holds_alternative<RandomWalk>(whole.estimate.model.terms[t].process))
        each[i].by_fit = whole.parameters[t][0].observability == Observability::kObserved ? 1 : 0;
    }
  });
  Kept out;
  for (const Kept& one : each) {
    out.by_error += one.by_error;
    out.by_likelihood += one.by_likelihood;
    out.by_one += one.by_one;
    out.by_fit += one.by_fit;
  }
  return out;
}

// A walk is kept at least as often as the fit's interval or CV-WVIC shows it, and hardly ever added
// where there is none.
TEST(HeldOutLikelihood, KeepsAWalkAndAddsNone) {
  constexpr std::size_t kWalks = 100;
  for (const bool there : {true, false}) {
    const Model truth =
        testing::model_of(there ? "AR1(sigma2=4e-4, phi=0.99) + WN(sigma2=1) + RW(gamma2=4e-7)"
                                : "AR1(sigma2=4e-4, phi=0.99) + WN(sigma2=1)");
    const Kept kept = walks_kept(truth, kWalks);
    std::printf(
        "%s: the fit sees a walk in %d, CV-WVIC keeps it in %d, the held-out likelihood in %d, "
        "that of one replicate in %d of %zu sets\n",
        there ? "with a walk" : "without", kept.by_fit, kept.by_error, kept.by_likelihood,
        kept.by_one, kWalks);
    if (there) {
      EXPECT_GE(kept.by_likelihood, kept.by_fit);
      EXPECT_GE(kept.by_likelihood, kept.by_error);
    } else {
      EXPECT_LE(kept.by_likelihood,
                5 + static_cast<int>(100.0 * testing::binomial_allowance(0.05, 100.0)));
    }
  }
}

INSTANTIATE_TEST_SUITE_P(Ways, Coverage, ::testing::Values(Splits::kLeaveOneOut, Splits::kHalf));

}  // namespace
}  // namespace imunoise
