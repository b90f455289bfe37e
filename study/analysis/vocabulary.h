#pragma once

// How the things of core are called in messages.

#include <string>
#include <string_view>

#include "core/model/model.h"

namespace imunoise::study {

/// Of tests that are told as yes or no.
inline constexpr double kLevel = 0.05;

/// "angular rate"; "" when unknown.
std::string_view quantity_name(Quantity quantity);

/// The unit of a parameter of a channel: "(rad/s)²", "s", "1".
std::string unit_of(Dimension dimension, Quantity quantity);

/// "AR1", or "AR1 (2)" when the model has several.
std::string label_of(const Model& model, std::size_t term);

/// What estimated the numbers of a report, as every report names it. From moments: "GMWM" of one
/// replicate, "MuGMWM" of several. Moments, then the maximum of the likelihood: "MuGMWM + Whittle".
std::string moments_estimator(std::size_t replicates);
std::string likelihood_estimator(const std::string& moments);

/// "p = 0.032", "p < 0.0001".
std::string chance_words(double p);

}  // namespace imunoise::study
