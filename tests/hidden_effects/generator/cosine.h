#pragma once

#include "tests/hidden_effects/generator/recording.h"

namespace imunoise::hidden {

/// Orthonormal DCT-II of a series whose length n is a power of two; entry k belongs to the
/// frequency k/2n cycles per sample, entry 0 to the mean. The coefficients k ≥ 1 of white noise
/// plus a random walk are exactly independent, with variance σ² + γ²/(4 sin²(πk/2n)): they
/// diagonalise the Laplacian of a path.
Series cosine_coefficients(const Series& values);

}  // namespace imunoise::hidden
