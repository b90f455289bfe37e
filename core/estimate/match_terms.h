#pragma once

#include "core/model/model.h"

namespace imunoise {

/// The same terms in the order in which they are most like those of a reference: terms of one kind
/// exchange their places until the squared differences of their variances at half-widths `m`, over
/// the reference's whole variance, are least. Exact for up to six terms of one kind; more stay as
/// they are.
Model matched(const Model& model, const Model& reference, HalfWidths m);

/// True where a model has terms of one kind, whose order means nothing.
bool has_equal_terms(const Model& model);

}  // namespace imunoise
