#pragma once

#include <vector>

#include "cli/arguments.h"
#include "core/effects/simulation.h"

namespace imunoise::cli {

/// A channel that effects follow, and the unit that it is written in.
struct WrittenWitness {
  SimulatedWitness witness;
  Unit unit;
};

/// The witnesses of a simulation: simulated, or read from files. Error: a model that cannot be read
/// or leaves values open; a file that cannot be read, is too short or of another rate; or fewer
/// files than replicates, and more than one.
Result<std::vector<WrittenWitness>> witnesses_of(const SimulateArguments& arguments);

}  // namespace imunoise::cli
