#pragma once

#include <optional>
#include <string>

#include "core/regression/fitted_model.h"

namespace imunoise {

/// A term that explains no more than chance beside all others, and the model without it.
struct UselessTerm {
  std::string term;   ///< in the grammar, without the noise's values
  double loss = 0.0;  ///< nats of likelihood that go with it
  FittedModel without;
};

/// The most useless term of a fitted model, if one is: its p-value at its place is above `level`.
/// What the noise of `kept` had from the start goes only where the fit puts its power to zero: what
/// slow effects leave of a random walk is too little to be seen, and yet as uncertain as they are.
/// The last noise term stays, and so do outliers, jumps, modulations and powers of each replicate,
/// which are no terms that are added up.
std::optional<UselessTerm> useless_term(const FittedModel& fitted, double level,
                                        const Model& kept = {});

}  // namespace imunoise
