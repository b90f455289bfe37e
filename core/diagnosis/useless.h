#pragma once

#include <optional>
#include <string>

#include "core/diagnosis/candidates.h"

namespace imunoise {

/// A term that explains no more than chance beside all others, and the model without it.
struct UselessTerm {
  std::string term;   ///< in the grammar, without the noise's values
  double loss = 0.0;  ///< nats of likelihood that go with it
  Trial without;
};

/// The most useless term of a fitted model, if one is: the chance that a term which is not there
/// gains as much at its place is above `level`. The last noise term stays, and so do outliers,
/// jumps, modulations and powers of each replicate, which are no terms that are added up.
std::optional<UselessTerm> useless_term(const Trial& trial, double level);

}  // namespace imunoise
