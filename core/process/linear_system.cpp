#include "core/process/linear_system.h"

#include "core/support/linear_algebra.h"

namespace imunoise {
namespace {

void draw(RandomStream& rng, Eigen::VectorXd& to) {
  for (double& one : to) one = rng.normal();
}

}  // namespace

LinearSystem::Recursion LinearSystem::recursion(double sigma, RandomStream& rng) const {
  Recursion out;
  out.transition_ = transition;
  out.input_ = input;
  out.output_ = sigma * output;
  Eigen::VectorXd start(stationary.rows());
  draw(rng, start);
  out.state_ = square_root(stationary) * start;
  out.source_.resize(input.cols());
  return out;
}

double LinearSystem::Recursion::next(RandomStream& rng) {
  const double now = output_.dot(state_);
  draw(rng, source_);
  next_.noalias() = transition_ * state_;
  next_.noalias() += input_ * source_;
  state_.swap(next_);
  return now;
}

}  // namespace imunoise
