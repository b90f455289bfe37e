#pragma once

#include <Eigen/Core>
#include <vector>

#include "core/diagnosis/subject.h"
#include "core/model/effect_term.h"
#include "core/support/linear_algebra.h"

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

/// An effect as regressors of every replicate. Kinds that are no regressors (modulation, outliers,
/// own powers) have no coefficients.
struct Regressors {
  std::vector<Columns> replicates;
  std::vector<CoefficientName> coefficients;
};

/// Precondition: the effect's witness exists and its replicate too, see check().
Regressors regressors_of(const EffectTerm& term, const Subject& subject);

/// Adds an effect to one replicate: its `columns` there as samples, up to a constant each, times
/// coefficients, one a column.
void add_effect(const EffectTerm& term, const Subject& subject, std::size_t replicate,
                const Columns& columns, const Eigen::VectorXd& coefficients, Eigen::VectorXd& to);

/// Error: a witness or replicate that the subject does not have, or a frequency that it cannot
/// show.
Result<void> check(const EffectTerm& term, const Subject& subject);

/// The response of a first-order lag of time constant `lag` samples > 0 to a series that stood at
/// its first value before: exact for a piecewise constant input.
Eigen::VectorXd lagged(const VectorRef& x, double lag);

/// Differences of neighbours times the sampling rate in Hz; the first is 0.
Eigen::VectorXd rate_of_change(const VectorRef& x, double rate);

}  // namespace imunoise
