#include "core/inference/near_stationarity.h"

#include <atomic>

#include "core/inference/moment_draws.h"
#include "core/support/parallel.h"

namespace imunoise {
namespace {

using Replicates = std::span<const WaveletVariance>;

// Everything that stays as it is from one set of moments to the next.
struct Frame {
  Model pooled;    // the estimate, from which every search starts
  Model diagonal;  // and the one of the published test
  std::vector<Eigen::MatrixXd> roots;
  PerReplicate<NormalScores> scores;
};

struct Statistics {
  Model pooled;
  std::vector<Minimum> separate;
  TestOutcome misfit;
  TestOutcome heterogeneity;
  double published = 0.0;
};

TestOutcome heterogeneity_test(const ScoreBlocks& blocks) {
  Eigen::VectorXd score = Eigen::VectorXd::Zero(blocks.score[0].size());
  Eigen::MatrixXd information = Eigen::MatrixXd::Zero(score.size(), score.size());
  double own = 0.0;
  Eigen::Index own_rank = 0;
  for (std::size_t k = 0; k < blocks.score.size(); ++k) {
    const Explained by_own = explained(blocks.score[k], blocks.information[k]);
    own += by_own.squares;
    own_rank += by_own.rank;
    score += blocks.score[k];
    information += blocks.information[k];
  }
  const Explained by_common = explained(score, information);
  return chi_square_test(own - by_common.squares, own_rank - by_common.rank);
}

Statistics statistics(const Frame& frame, Replicates replicates) {
  Statistics out;
  const Problem all = tied_problem(frame.pooled, replicates, frame.roots);
  out.pooled = sorted(minimise_from(all, frame.pooled).model);
  out.heterogeneity = heterogeneity_test(ScoreBlocks(out.pooled, replicates, frame.scores));
  double misfit = 0.0;
  Eigen::Index degrees = 0;
  for (std::size_t k = 0; k < replicates.size(); ++k) {
    const Replicates one = replicates.subspan(k, 1);
    const std::span<const Eigen::MatrixXd> root(&frame.roots[k], 1);
    Minimum separate = minimise_from(tied_problem(frame.pooled, one, root), out.pooled);
    separate.model = sorted(std::move(separate.model));
    out.separate.push_back(std::move(separate));
    const auto scores =
        PerReplicate<NormalScores>::of(one, [&](std::size_t) { return frame.scores[k]; });
    const TestOutcome own = goodness_of_fit(ScoreBlocks(out.separate[k].model, one, scores));
    misfit += own.statistic;
    degrees += own.degrees_of_freedom;
  }
  out.misfit = chi_square_test(misfit, degrees);
  const Problem peers = tied_problem(frame.diagonal, replicates, diagonal_roots(replicates));
  out.published = minimise_from(peers, frame.diagonal).objective;
  return out;
}

struct Exceedances {
  std::atomic<int> misfit = 0;
  std::atomic<int> heterogeneity = 0;
  std::atomic<int> published = 0;
};

void bootstrap(NearStationarity& out, const Frame& frame, const Statistics& seen,
               Replicates replicates, const MomentCovariances& covariances,
               const BootstrapOptions& options, const Progress& progress) {
  const MomentDraws draws(frame.pooled, replicates, covariances);
  Exceedances more;
  std::atomic<int> done = 0;
  for_each_index(static_cast<std::size_t>(options.sets), [&](std::size_t b) {
    if (progress.stopped()) return;
    RandomStream stream(options.seed, {static_cast<std::uint32_t>(b)});
    const Statistics drawn = statistics(frame, draws.draw(stream));
    more.misfit += drawn.misfit.statistic >= seen.misfit.statistic ? 1 : 0;
    more.heterogeneity += drawn.heterogeneity.statistic >= seen.heterogeneity.statistic ? 1 : 0;
    more.published += drawn.published >= seen.published ? 1 : 0;
    progress.report(static_cast<double>(++done) / options.sets);
  });
  if (progress.stopped()) return;
  const auto p_value = [&](int count) { return (1.0 + count) / (1.0 + options.sets); };
  out.misfit.bootstrap_p_value = p_value(more.misfit);
  out.heterogeneity.bootstrap_p_value = p_value(more.heterogeneity);
  out.published_p_value = p_value(more.published);
}

}  // namespace

NearStationarity near_stationarity(const Model& model, Replicates replicates,
                                   const BootstrapOptions& options, const Progress& progress) {
  NearStationarity out;
  out.pooled = mugmwm(model, replicates, Weighting::kFull, progress.part(0.0, 0.2));
  const MomentCovariances covariances = moment_covariances(out.pooled.model, replicates);
  const Frame frame{out.pooled.model, mugmwm(model, replicates, Weighting::kDiagonal).model,
                    out.pooled.weight_roots,
                    normal_scores(out.pooled.model, replicates, covariances)};
  Statistics seen = statistics(frame, replicates);
  out.misfit.asymptotic = seen.misfit;
  out.heterogeneity.asymptotic = seen.heterogeneity;
  out.published_statistic = seen.published;
  for (std::size_t k = 0; k < replicates.size(); ++k) {
    Minimum& own = seen.separate[k];
    out.separate.push_back({std::move(own.model),
                            own.objective,
                            own.termination,
                            Weighting::kFull,
                            {out.pooled.weight_roots[k]}});
  }
  out.spread = parameter_spread(out.separate, replicates);
  if (options.sets > 0) {
    bootstrap(out, frame, seen, replicates, covariances, options, progress.part(0.2, 1.0));
  }
  return out;
}

}  // namespace imunoise
