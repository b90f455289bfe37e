#pragma once

// How visible an effect is: the non-centrality δ of the likelihood ratio of an observer who knows
// the base noise and the effect's form. In all of it the noise is independent over cosine
// coefficients, with the variances of a spectrum (entry k-1 for k ≥ 1; the mean is unknown and left
// out).
//
// δ = √(2·KL), KL the divergence in nats of the data with the effect from those without: the mean
// of the log-likelihood ratio when the effect is there. For a Gaussian shift that is the shift in
// standard deviations; for a faint change of a spectrum it is the ratio's deflection (E1 - E0)/sd.
// For a strong change of few coefficients the deflection means little (with the sd of the effect it
// never exceeds one a coefficient, with the sd of its absence it grows as the variance does), while
// exp(-KL) remains the false alarm rate at which half of the effects are found (Stein's lemma), as
// it is exp(-δ²/2) for a shift.

#include <functional>
#include <vector>

#include "tests/hidden_effects/generator/recording.h"

namespace imunoise::hidden {

/// δ of shapes added to the series, one a replicate: √(Σ hᵀΣ⁻¹h).
double mean_strength(const std::vector<Series>& shapes, const Series& spectrum);

/// KL of variances `after` from `before`, one independent coefficient each; nats.
double divergence(const Series& before, const Series& after);

/// Log-likelihood of cosine coefficients (entry 0, the mean, is left out) under variances `after`,
/// over that under `before`; nats.
double likelihood_ratio(const Series& coefficients, const Series& before, const Series& after);

/// The sum of `parts`, their levels free, from which `after` diverges least.
Series nearest_sum(const Series& after, const std::vector<Series>& parts);

/// KL of two channels of spectra a and b that share one more of spectrum `common`, from two
/// channels of the same spectra that share nothing: -½ Σ ln(1 - coherence²); nats. What each gains
/// alone counts for nothing.
double shared_divergence(const Series& a, const Series& b, const Series& common);

/// KL of a sample that is normal with variances[j] with probability weights[j], from the normal
/// sample of the same variance; nats.
double mixture_divergence(const Series& weights, const Series& variances);

/// KL of a sample of N(0, 1) that with probability `share` becomes N(0, 1 + factor²), from the
/// normal sample of the same variance; nats.
double outlier_divergence(double share, double factor);

/// What it costs an observer of a wave not to be told its phase, which may be any: how far the
/// mean of the log-likelihood ratio, summed over phases, stays behind δ²/2, nats. For a wave that
/// stands out it grows as ½ ln(2πδ²) - ½.
double phase_price(double delta);

/// δ of `count` independent repetitions.
double strength(double divergence, double count);

/// δ of white noise whose variance becomes `after`, for an observer who must fit its mean: only
/// what swings around that is evidence.
double swing_strength(const Series& after);

/// The x in [low, high] at which the increasing strength(x) is `delta`, by bisection of ln x;
/// high when it never is.
double solve_strength(double delta, double low, double high,
                      const std::function<double(double)>& strength);

}  // namespace imunoise::hidden
