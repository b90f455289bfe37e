#pragma once

#include <vector>

#include "core/effect/effect_term.h"
#include "core/model/model.h"

namespace imunoise {

/// A noise model and the effects that add to it. Read by parse_full_model(), core/effects.
struct FullModel {
  Model noise;
  std::vector<EffectTerm> effects{};
  friend bool operator==(const FullModel&, const FullModel&) = default;
};

/// `WN + RW + line(f=0.51)`: the noise, then the effects.
std::string print(const FullModel& model);
/// The same with every value of the noise.
std::string print_with_values(const FullModel& model);

/// The channels that the effects follow, each once.
std::vector<std::string> witnesses_of(const FullModel& model);

}  // namespace imunoise
