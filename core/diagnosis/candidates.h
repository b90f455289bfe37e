#pragma once

#include "core/diagnosis/scan.h"

namespace imunoise {

/// A model that was tried: the current one with something added, fitted as one.
struct Trial {
  Regression regression;
  JointFit fit;
};

/// The current model with a suggestion added. Outliers are taken out of the samples first.
Trial try_out(const Current& current, const Suggestion& suggestion);

/// A suggestion that was tried.
struct TriedEffect {
  std::string effect;  ///< its id; may be told better than the suggestion could
  Suggestion suggestion;
  Trial trial;
  double likelihood_gain = 0.0;  ///< nats
  double log_chance = 0.0;       ///< that noise makes this search gain as much, logarithm
  double gain = 0.0;             ///< likelihood_gain less what such a search gains by chance, nats
  double freedom = 0.0;          ///< degrees of freedom behind the noise level there
  std::string shared_with{};     ///< noise: the witness that feels it too; empty where none does
  bool slow = false;             ///< heat could have done it, had nobody recorded the temperature
  bool steady = true;            ///< noise: it is there all the time; jumps: between two levels
};

/// Sorts by gain; equals stay in order.
void best_first(std::vector<TriedEffect>& effects);

/// Every suggestion that is worth it, tried on the current model, best first.
std::vector<TriedEffect> try_all(const Current& current, const Suggestions& suggestions,
                                 const Progress& progress = {});

}  // namespace imunoise
