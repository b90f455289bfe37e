#pragma once

#include <memory>
#include <optional>
#include <vector>

#include "core/regression/current.h"

namespace imunoise {

/// Single samples that stand out from what the noise before and after them makes likely.
struct DisturbedSamples : Found {
  std::vector<std::vector<Eigen::Index>> places;  ///< of each replicate, ascending
  std::vector<std::vector<double>> sizes;         ///< the same, unit

  std::size_t count() const;
};

/// A subject with disturbed samples taken out.
struct Undisturbed {
  std::shared_ptr<Subject> subject;  ///< own_nats: with what taking them out costs
  DisturbedSamples taken_out{};
  double above = 0.0;      ///< the threshold, standard deviations
  double gain_nats = 0.0;  ///< log-likelihood that taking them out gains, without its cost
};

inline constexpr double kLeastDisturbed = 3.0;  ///< standard deviations: less is noise

/// Takes out the samples beyond `above` standard deviations of what single samples can be told by:
/// the matched filter of an impulse under the noise. Of neighbours it takes the largest first. The
/// strongest make noise look louder and hide others; so the noise is fitted anew, and they are
/// sought again, until none is left. Absent `above`: what the noise of so many samples passes once
/// in 20 recordings; or, where there are many, less, from where on one is disturbed more likely
/// than not.
Undisturbed undisturbed(const Current& current, std::optional<double> above = std::nullopt);

}  // namespace imunoise
