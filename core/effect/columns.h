#pragma once

#include <Eigen/Core>
#include <functional>
#include <string>
#include <vector>

#include "core/effect/effect_term.h"
#include "core/effect/shapes.h"
#include "core/effect/subject.h"

namespace imunoise {

/// What one effect adds to the mean of one replicate: samples, a column a coefficient. Each
/// coefficient is a place in the list of all of the effect's; those shared by the replicates have
/// the same place in each.
struct Columns {
  std::vector<SharedVector> cosines;  ///< the cosine_transform() of each
  std::vector<Eigen::Index> places;   ///< one a column
  std::vector<SharedVector> samples;  ///< of each, where they are at hand
};

/// A coefficient of an effect, for people.
struct CoefficientName {
  std::string name;              ///< "slope", "cosine", "height"
  std::size_t replicate = kAll;  ///< the one that it belongs to
  static constexpr std::size_t kAll = static_cast<std::size_t>(-1);
};

/// An effect as regressors of every replicate. An effect that is none has no coefficients.
struct Regressors {
  std::vector<Columns> replicates;
  std::vector<CoefficientName> coefficients;
};

/// As they are beside what made the subject's power even.
/// Precondition: the effect's witness exists and its replicate too, see check().
Regressors regressors_of(const EffectTerm& term, const Subject& subject);

/// Regressors beside the first `known` evenings of a subject, made even by the others, too.
Regressors made_even(Regressors columns, const Subject& subject, std::size_t known);

/// Adds an effect to one replicate: its `columns` there as samples, up to a constant each, times
/// coefficients, one a column.
void add_effect(const EffectTerm& term, const Subject& subject, std::size_t replicate,
                const Columns& columns, const Eigen::VectorXd& coefficients, Eigen::VectorXd& to);

/// Error: a witness or replicate that the subject does not have, a frequency that it cannot show,
/// or a size that a fit would have to keep.
Result<void> check(const EffectTerm& term, const Subject& subject);

/// The error `print(term): what`.
tl::unexpected<Error> unfit(const EffectTerm& term, const std::string& what);
/// The error that a term is faster than half the sampling rate.
tl::unexpected<Error> too_fast(const EffectTerm& term, const Subject& subject);

// What effects make their regressors with.

/// Regressors that every replicate has: one set of coefficients, or one a replicate.
/// `columns_in`: those of replicate k, without places.
Regressors in_all(const Subject& subject, bool own, const std::vector<std::string>& names,
                  const std::function<Columns(std::size_t k)>& columns_in);

/// The form of a known effect in a replicate that begins at this sample of what was recorded.
using ShapeFrom = std::function<Shape(Eigen::Index first)>;

/// The same of effects of known form: replicates of one length that begin alike share their
/// columns.
Regressors shaped(const Subject& subject, bool own, const std::vector<std::string>& names,
                  const ShapeFrom& shape);

/// The columns of a matrix, which they share.
std::vector<SharedVector> columns_of(Eigen::MatrixXd matrix);

}  // namespace imunoise
