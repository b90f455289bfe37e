#pragma once

// How the things of core are called in messages.

#include <string>
#include <string_view>

#include "core/model/model.h"
#include "core/support/result.h"
#include "imunoise/v1/noise.pb.h"

namespace imunoise::study {

/// Of tests that are told as yes or no.
inline constexpr double kLevel = 0.05;
/// Error: a bootstrap of so many sets, whose smallest p-value is 1/(sets + 1), cannot reject at
/// kLevel. None at all is no error.
Result<void> check_bootstrap(std::size_t sets);

/// "angular rate"; "" when unknown.
std::string_view quantity_name(Quantity quantity);

/// The unit of a parameter of a channel: "(rad/s)²", "s", "1".
std::string unit_of(Dimension dimension, Quantity quantity);

/// "AR1", or "AR1 (2)" when the model has several.
std::string label_of(const Model& model, std::size_t term);

/// A coefficient of a term of this label, in SI and in the units of data sheets, without interval.
v1::Coefficient coefficient_message(Coefficient which, double value, const std::string& label,
                                    Quantity measures);
/// A term with its values, and its wavelet variance at the half-widths `m`; without intervals.
v1::Term term_message(const Model& model, std::size_t term, Quantity measures, Hertz rate,
                      const Eigen::ArrayXd& m);

/// What estimated the numbers of a report, as every report names it. From moments: "GMWM" of one
/// replicate, "MuGMWM" of several. Moments, then the maximum of the likelihood: "MuGMWM + Whittle".
std::string moments_estimator(std::size_t replicates);
std::string likelihood_estimator(const std::string& moments);

/// "p = 0.032", "p < 0.0001".
std::string chance_words(double p);

}  // namespace imunoise::study
