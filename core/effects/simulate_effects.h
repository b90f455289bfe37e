#pragma once

#include "core/effect/full_model.h"
#include "core/effect/subject.h"

namespace imunoise {

/// Error: a term whose size is not given, or whose witness `beside` lacks.
Result<void> check_simulation(const std::vector<EffectTerm>& terms, const Subject& beside);

/// Puts effects into `samples` of simulated noise, one replicate: first those that change the
/// noise, then those that add to it. Each term has a random stream of its own under (seed,
/// replicate), apart from those of the noise. `beside`: rate, parts, and the samples of the
/// witnesses. Precondition: check_simulation().
void simulate_effects(const std::vector<EffectTerm>& terms, const Subject& beside,
                      std::size_t replicate, std::uint64_t seed, Eigen::VectorXd& samples);

}  // namespace imunoise
