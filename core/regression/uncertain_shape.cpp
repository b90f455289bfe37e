#include "core/regression/uncertain_shape.h"

#include <algorithm>
#include <optional>

#include "core/support/linear_algebra.h"

namespace imunoise {
namespace {

using Index = Eigen::Index;

// The place of a time constant that the term gives.
std::optional<std::size_t> time_constant(const EffectTerm& term) {
  const auto& all = term.effect->parameters;
  for (std::size_t i = 0; i < term.values.size(); ++i) {
    if (all[i].error == ShapeError::kLogarithm && term.given(i) && term[i] > 0.0) return i;
  }
  return std::nullopt;
}

}  // namespace

Eigen::ArrayXd growth_by_shape(const FittedEffect& effect) {
  constexpr double kNear = 0.95;  // of the time constant: columns that span its derivative, too
  const Regression& regression = effect.model.regression;
  const Index first = regression.first(effect.number);
  const Index count = regression.first(effect.number + 1) - first;
  const Eigen::ArrayXd ones = Eigen::ArrayXd::Ones(count);
  const std::optional<std::size_t> place = time_constant(effect.term());
  if (!place || count == 0) return ones;
  EffectTerm other = effect.term();
  other.values[*place] *= kNear;
  if (!check(other, effect.subject())) return ones;
  const Regression both = regression.with(other);
  const Index last = both.first(regression.effects().size());
  const Model& noise = effect.model.fit.model.noise;
  const Eigen::MatrixXd joint = both.under(noise).covariance;
  // Of these coefficients and of those near them; the other effects are free.
  Eigen::MatrixXd own(2 * count, 2 * count);
  own << joint.block(first, first, count, count), joint.block(first, last, count, count),
      joint.block(last, first, count, count), joint.block(last, last, count, count);
  // A course with a coefficient c and a changed time constant is (c - s b) of the first columns and
  // s b of the others, b the coefficients that were found and s the change.
  const Eigen::VectorXd found = effect.model.fit.effects.value.segment(first, count);
  Eigen::MatrixXd map = Eigen::MatrixXd::Zero(2 * count, count + 1);
  map.topLeftCorner(count, count).setIdentity();
  map.block(0, count, count, 1) = -found;
  map.block(count, count, count, 1) = found;
  const Eigen::MatrixXd information = pseudo_inverse(own).matrix;
  const Eigen::VectorXd wide =
      pseudo_inverse(map.transpose() * information * map).matrix.diagonal().head(count);
  const Eigen::VectorXd narrow =
      regression.under(noise).covariance.diagonal().segment(first, count);
  return (wide.array() / narrow.array()).max(1.0).sqrt();
}

}  // namespace imunoise
