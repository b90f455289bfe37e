#pragma once

#include <string>
#include <string_view>
#include <vector>

#include "core/effect/full_model.h"
#include "core/model/grammar.h"
#include "core/support/result.h"

namespace imunoise {

/// Reads `WN + RW + line(f=0.51) + witness(temperature, lag=300)`: noise processes and effects in
/// any order, at least one process. Error: what is wrong, or what `grammar` does not take, with the
/// text and a caret under the character.
Result<FullModel> parse_full_model(std::string_view text, Hertz rate, const Grammar& grammar = {});

/// The same where effects cannot be. Precondition: grammar.no_effects says why.
Result<Model> parse_noise_model(std::string_view text, Hertz rate, const Grammar& grammar);

/// For models of several sensors, of noise over a covariate, and of replicates that `command`
/// compares.
Grammar grammar_of_arrays();
Grammar grammar_over_covariate();
Grammar grammar_of_replicates(std::string_view command);

/// Adds a model to those that a choice is between. Error: as parse_full_model(), a model that is
/// there already, or one with other effects than they.
Result<void> add_candidate(std::string_view text, Hertz rate, std::string_view command,
                           std::vector<FullModel>& to);

/// The model as a joint fit takes it: effects without their sizes, and DR, a ramp of each
/// replicate, as the effect `ramp(own)`.
FullModel as_fitted(FullModel model);

}  // namespace imunoise
