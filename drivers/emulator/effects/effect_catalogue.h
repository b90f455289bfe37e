#pragma once

// Effects by name, as people write them.

#include <cstdint>
#include <memory>
#include <string>
#include <string_view>
#include <vector>

#include "core/support/result.h"
#include "drivers/emulator/effects/effect.h"

namespace imunoise::emulator {

/// Effects in the order in which they act.
struct Effects {
  std::vector<std::unique_ptr<Effect>> surroundings;  ///< Temperature and supply move.
  std::vector<std::unique_ptr<Effect>> disturbances;  ///< What adds to a quantity.
  std::vector<std::unique_ptr<Effect>> limits;        ///< What the output does, noise and all.
};

/// Adds what a text says, as "fan(frequency=23, amplitude=1e-3, channel=gyro_x)"; without a channel
/// it acts on all three gyroscopes, each with random numbers of its own. `at_rest`: couplings count
/// from there. `index`: tells the random numbers of several texts apart. Error: an effect that
/// there is not, numbers that it does not take.
Result<void> add_effect(std::string_view text, const Measurement& at_rest, std::uint64_t seed,
                        std::uint32_t index, Effects& effects);

/// What there is: a line for each effect, how it is written and what it does.
std::vector<std::string> describe_effects();

}  // namespace imunoise::emulator
