#pragma once

// The steps that most effects share.

#include <functional>
#include <vector>

#include "tests/hidden_effects/generator/effect.h"

namespace imunoise::hidden {

/// Adds shapes (one a replicate) to gyro_x, all times the one factor that makes δ = √(Σ hᵀΣ⁻¹h)
/// what is asked. Returns the factor.
double add_shapes(Scene& scene, const std::vector<Series>& shapes, double delta);

/// What was put in, of an effect of the mean: δ does not suffer from unknown noise levels, because
/// the information about means and variances is orthogonal.
Injection of_mean(double delta, std::vector<TrueParameter> parameters);

/// What was put in, of gyro_x's spectrum becoming `after` in every replicate.
Injection of_spectrum(const Scene& scene, const Series& after);

/// The same once it was put in: with the nats that the data themselves give.
Injection of_data(const Scene& scene, const Series& after);

/// The size in [low, high] at which the spectrum `after(size)`, which moves away from the scene's
/// as the size grows, has the δ asked.
double solve_size(const Scene& scene, double delta, double low, double high,
                  const std::function<Series(double size)>& after);

/// Adds noise of law `shape(deviation)` to gyro_x of every replicate, the deviation (unit of
/// gyro_x) such that δ is what is asked; powers must go with its square.
Injection add_noise(Scene& scene, double delta,
                    const std::function<BaseNoise(double deviation)>& shape, double& deviation);

/// Adds white noise to gyro_x whose variance follows `courses` (one a replicate, ≥ 0), all times
/// the one factor that makes δ what is asked, beside the white floor and for an observer who must
/// fit the mean level: only what swings around that is evidence. Its parameter `growth` is the
/// variance that comes to that of the white floor where a course is 1.
Injection add_power(Scene& scene, const std::vector<Series>& courses, double delta);

}  // namespace imunoise::hidden
