#include "core/inference/model_choice.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <numeric>
#include <utility>

#include "core/inference/goodness.h"
#include "core/support/distributions.h"
#include "core/support/parallel.h"

namespace imunoise {
namespace {

using Replicates = std::span<const WaveletVariance>;
constexpr double kSame = 1e-6;  // a difference of merits that is none

using Fold = std::vector<bool>;  // which replicates are held out

std::vector<Fold> folds(std::size_t count, Splits splits) {
  const std::size_t held = splits == Splits::kLeaveOneOut ? 1 : count / 2;
  Fold fold(count, false);
  std::fill(fold.begin(), fold.begin() + static_cast<std::ptrdiff_t>(held), true);
  std::vector<Fold> out;
  do out.push_back(fold);
  while (std::prev_permutation(fold.begin(), fold.end()));
  return out;
}

// The distance between a replicate and what a model expects of it, and what noise alone makes it.
class Distance {
 public:
  Distance(const Model& reference, Replicates replicates, Weighting weighting)
      : replicates_(replicates),
        weighting_(weighting),
        covariances_(moment_covariances(reference, replicates)),
        scores_(normal_scores(reference, replicates, covariances_)),
        diagonal_(diagonal_roots(replicates)) {
    for (const WaveletVariance& wv : replicates) {
      expected_.push_back(variance(reference, wv.scales.half_widths()));
    }
  }

  double operator()(std::size_t k, const Model& model) const {
    const WaveletVariance& wv = replicates_[k];
    const Eigen::ArrayXd nu = variance(model, wv.scales.half_widths());
    if (weighting_ == Weighting::kDiagonal) {
      return (diagonal_[k] * (wv.variance - nu).matrix()).squaredNorm();
    }
    return (scores_[k].residual(wv.variance, expected_[k]) - scores_[k].shift(nu, expected_[k]))
        .squaredNorm();
  }

  double floor(std::size_t k) const {
    if (weighting_ == Weighting::kFull) return static_cast<double>(scores_[k].size());
    return (diagonal_[k] * covariances_[k] * diagonal_[k].transpose()).trace();
  }

 private:
  Replicates replicates_;
  Weighting weighting_;
  MomentCovariances covariances_;
  PerReplicate<NormalScores> scores_;
  std::vector<Eigen::MatrixXd> diagonal_;
  std::vector<Eigen::ArrayXd> expected_;
};

// Held-out distance of each replicate in units of the floor: the average over the folds that hold
// it out.
Eigen::ArrayXd held_out(const Model& fitted, std::span<const Eigen::MatrixXd> roots,
                        Replicates replicates, const Distance& distance,
                        const std::vector<Fold>& splits) {
  const auto count = static_cast<Eigen::Index>(replicates.size());
  Eigen::ArrayXd sum = Eigen::ArrayXd::Zero(count);
  Eigen::ArrayXd times = Eigen::ArrayXd::Zero(count);
  for (const Fold& fold : splits) {
    std::vector<WaveletVariance> training;
    std::vector<Eigen::MatrixXd> training_roots;
    for (std::size_t k = 0; k < fold.size(); ++k) {
      if (fold[k]) continue;
      training.push_back(replicates[k]);
      training_roots.push_back(roots[k]);
    }
    const Model model =
        sorted(minimise_from(tied_problem(fitted, training, training_roots), fitted).model);
    for (std::size_t k = 0; k < fold.size(); ++k) {
      if (!fold[k]) continue;
      sum(static_cast<Eigen::Index>(k)) += distance(k, model) / distance.floor(k);
      times(static_cast<Eigen::Index>(k)) += 1.0;
    }
  }
  return sum / times;
}

Interval mean_interval(const Eigen::ArrayXd& sample) {
  const auto count = static_cast<double>(sample.size());
  const double mean = sample.mean();
  const double error = std::sqrt((sample - mean).square().sum() / (count * (count - 1.0)));
  const double reach = student_quantile(0.975, count - 1.0) * error;
  return {mean, mean - reach, mean + reach};
}

// By how much one model's held-out distances exceed another's; what is only rounding counts as
// nothing.
Interval excess_over(const Eigen::ArrayXd& best, const Eigen::ArrayXd& own) {
  const Eigen::ArrayXd difference = own - best;
  return mean_interval((difference.abs() < kSame).select(0.0, difference));
}

// The candidate that describes all replicates best: its covariance of moments is nearest the truth.
std::size_t closest(std::span<const Estimate> fits, Replicates replicates) {
  std::size_t best = 0;
  double least = std::numeric_limits<double>::infinity();
  for (std::size_t c = 0; c < fits.size(); ++c) {
    const Model& model = fits[c].model;
    const auto scores = normal_scores(model, replicates, moment_covariances(model, replicates));
    const double misfit = goodness_of_fit(ScoreBlocks(model, replicates, scores)).statistic;
    if (misfit < least) {
      least = misfit;
      best = c;
    }
  }
  return best;
}

}  // namespace

std::vector<Model> sub_models(const Model& model) {
  std::vector<Term> kinds;
  std::vector<std::size_t> most;
  for (const Term& term : model.terms) {
    const auto found = std::find(kinds.begin(), kinds.end(), term);
    if (found == kinds.end()) {
      kinds.push_back(term);
      most.push_back(1);
    } else {
      ++most[static_cast<std::size_t>(found - kinds.begin())];
    }
  }
  std::vector<Model> out;
  std::vector<std::size_t> count(kinds.size(), 0);
  for (;;) {
    std::size_t digit = 0;
    while (digit < count.size() && count[digit] == most[digit]) count[digit++] = 0;
    if (digit == count.size()) return out;
    ++count[digit];
    Model one;
    for (std::size_t i = 0; i < kinds.size(); ++i) {
      one.terms.insert(one.terms.end(), count[i], kinds[i]);
    }
    out.push_back(std::move(one));
  }
}

ModelChoice choose_model(std::span<const Model> models, Replicates replicates,
                         const ChoiceOptions& options, const Progress& progress) {
  std::vector<Estimate> fits(models.size());
  for (std::size_t c = 0; c < models.size(); ++c) {
    const auto at = static_cast<double>(c) / static_cast<double>(models.size());
    fits[c] = mugmwm(models[c], replicates, Weighting::kFull, progress.part(at, at));
  }
  ModelChoice out = choose_model(fits, replicates, options);
  progress.report(1.0);
  return out;
}

ModelChoice choose_model(std::span<const Estimate> fits, Replicates replicates,
                         const ChoiceOptions& options) {
  const std::size_t reference = closest(fits, replicates);
  const Distance distance(fits[reference].model, replicates, options.weighting);
  const std::vector<Eigen::MatrixXd> roots = options.weighting == Weighting::kFull
                                                 ? fits[reference].weight_roots
                                                 : diagonal_roots(replicates);
  const std::vector<Fold> splits = folds(replicates.size(), options.splits);
  std::vector<Eigen::ArrayXd> merits(fits.size());
  for_each_index(fits.size(), [&](std::size_t c) {
    merits[c] = held_out(fits[c].model, roots, replicates, distance, splits);
  });

  std::vector<std::size_t> order(fits.size());
  std::iota(order.begin(), order.end(), std::size_t{0});
  // Models that predict the same (one has a term that the fit put at zero) are told by their size.
  const auto rank = [&](std::size_t c) {
    return std::pair(std::llround(merits[c].mean() / kSame), parameter_count(fits[c].model));
  };
  std::stable_sort(order.begin(), order.end(),
                   [&](std::size_t a, std::size_t b) { return rank(a) < rank(b); });
  ModelChoice out;
  out.splits = splits.size();
  for (const std::size_t c : order) {
    Candidate candidate;
    candidate.place = c;
    candidate.model = fits[c].model;
    candidate.merit = mean_interval(merits[c]);
    candidate.merit.lower = std::max(0.0, candidate.merit.lower);
    candidate.excess = excess_over(merits[order[0]], merits[c]);
    candidate.verdict = c == order[0]                  ? ChoiceVerdict::kSelected
                        : candidate.excess.lower > 0.0 ? ChoiceVerdict::kNotAppropriate
                                                       : ChoiceVerdict::kEquivalent;
    out.candidates.push_back(std::move(candidate));
  }
  return out;
}

}  // namespace imunoise
