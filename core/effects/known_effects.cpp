#include "core/effects/known_effects.h"

#include <algorithm>
#include <array>
#include <cassert>

// One line an effect: the name of its file, and of the function there that gives its descriptor.
#define IMUNOISE_EFFECTS(EFFECT) \
  EFFECT(ramp)                   \
  EFFECT(warm_up)                \
  EFFECT(line)                   \
  EFFECT(wander)                 \
  EFFECT(oscillation)            \
  EFFECT(step)                   \
  EFFECT(common_course)          \
  EFFECT(witness)                \
  EFFECT(two_lags)               \
  EFFECT(modulated)              \
  EFFECT(telegraph)              \
  EFFECT(outliers)               \
  EFFECT(heavy_tails)            \
  EFFECT(variance_wander)        \
  EFFECT(bursts)                 \
  EFFECT(power_change)           \
  EFFECT(own_powers)

namespace imunoise {

namespace effects {
#define IMUNOISE_DECLARE(NAME) const Effect& NAME();
IMUNOISE_EFFECTS(IMUNOISE_DECLARE)
#undef IMUNOISE_DECLARE
}  // namespace effects

std::span<const Effect* const> known_effects() {
#define IMUNOISE_LIST(NAME) &effects::NAME(),
  static const std::array kAll{IMUNOISE_EFFECTS(IMUNOISE_LIST)};
#undef IMUNOISE_LIST
  return kAll;
}

const Effect* effect_called(std::string_view name) {
  const std::span<const Effect* const> all = known_effects();
  const auto found =
      std::find_if(all.begin(), all.end(), [&](const Effect* one) { return one->name == name; });
  return found == all.end() ? nullptr : *found;
}

const Effect& effect_named(std::string_view name) {
  const Effect* const found = effect_called(name);
  assert(found != nullptr);
  return *found;
}

}  // namespace imunoise
