#pragma once

#include <Eigen/Core>
#include <cstdint>

#include "core/array/latents.h"

namespace imunoise {

/// One realisation of n samples of every sensor: samples × sensors. Innovations of a [corr] process
/// are correlated by the square root of its powers. Each latent process has a stream of its own
/// under (seed, replicate).
Eigen::MatrixXd simulate(const ArrayModel& model, std::size_t n, std::uint64_t seed,
                         std::uint32_t replicate);

}  // namespace imunoise
