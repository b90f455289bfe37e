#pragma once

#include <span>

#include "core/array/array_estimate.h"
#include "core/spectrum/cross_power.h"

namespace imunoise {

/// Whittle's likelihood of an array: at each frequency the coefficients of all sensors' cosine
/// transforms are jointly normal, with the model's cross spectra as covariance, and independent of
/// those at other frequencies. Models with a ramp (DR), which is no noise, are not taken: give its
/// time as a regressor instead.

/// Whether a model is one that the likelihood takes.
bool has_likelihood(const ArrayModel& model);

/// -log likelihood in nats, less what does not depend on the model: Σ n/2 (log det Σ + tr Σ⁻¹C).
/// Infinite where the model's cross spectra are singular.
double whittle_objective(const ArrayModel& model, std::span<const CrossPower> replicates);

/// A fit of moments carried on to the maximum of the likelihood of the same replicates: estimates,
/// and intervals from the Fisher information. On short series it is far more precise than moments,
/// and its intervals hold where those of moments are too narrow (docs/arrays.md). `objective` stays
/// that of the moments. Precondition: has_likelihood().
ArrayFit make_efficient(ArrayFit fit, std::span<const CrossPower> replicates,
                        double confidence = 0.95, const Progress& progress = {});

/// One step of Fisher scoring from a fitted model: to first order, the estimate from these series.
/// What a bootstrap needs of thousands of them.
ArrayModel one_step(const ArrayModel& model, std::span<const CrossPower> replicates);

}  // namespace imunoise
