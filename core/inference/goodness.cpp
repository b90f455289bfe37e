#include "core/inference/goodness.h"

#include <algorithm>

#include "core/support/distributions.h"

namespace imunoise {

TestOutcome chi_square_test(double statistic, Eigen::Index degrees_of_freedom) {
  const int degrees = static_cast<int>(degrees_of_freedom);
  return {statistic, degrees, chi_square_tail(std::max(0.0, statistic), degrees)};
}

TestOutcome goodness_of_fit(const ScoreBlocks& blocks) {
  double squares = 0.0;
  Eigen::Index size = 0;
  Eigen::VectorXd score = Eigen::VectorXd::Zero(blocks.score[0].size());
  Eigen::MatrixXd information = Eigen::MatrixXd::Zero(score.size(), score.size());
  for (std::size_t k = 0; k < blocks.score.size(); ++k) {
    squares += blocks.squares[k];
    size += blocks.sizes[k];
    score += blocks.score[k];
    information += blocks.information[k];
  }
  const Explained by_parameters = explained(score, information);
  return chi_square_test(squares - by_parameters.squares, size - by_parameters.rank);
}

}  // namespace imunoise
