#pragma once

#include <functional>
#include <memory>
#include <optional>

#include "core/effects/distributions/power_memory.h"
#include "core/regression/current.h"
#include "core/regression/fitted_model.h"

namespace imunoise {

/// How one replicate's innovations become normal numbers of one variance.
struct Reshaping {
  Eigen::ArrayXd factor;  ///< of each innovation
  /// What the distribution behind it gains over the normal one; absent for normal numbers as wide
  /// as the factors say, whose likelihood needs no other word.
  std::optional<double> nats{};
  /// Where a factor depends on its innovation alone: how much the normal number changes with the
  /// innovation, on average. Absent: the factors are those of the noise's power.
  std::optional<double> slope{};
};

/// The subject with the innovations of what a fit leaves multiplied by a factor each, the nats of
/// that in its reshaped_nats, and what it makes of effects in its evenings. `reshape`: of a
/// replicate whose innovations are given; called by several threads.
std::shared_ptr<Subject> reshaped(
    const Current& current,
    const std::function<Reshaping(const Eigen::VectorXd& white, std::size_t replicate)>& reshape);

/// Excess kurtosis of innovations, each replicate against its own level; and of how many.
struct Tails {
  double excess = 0.0;
  double samples = 0.0;
};
Tails tails_of(const Innovations& innovations);

/// Whether the innovations of a fit with changing noise power have tails significantly further from
/// normal ones than before it. Changing power makes large deviations more frequent. If the power
/// changed without them, the spectrum of the model is wrong, and its innovations are not
/// independent.
bool worsens_tails(const Current& before, const FittedModel& after);
/// Whether that is sure before a fit: the innovations' kurtosis is divided by `kurtosis_ratio`.
bool will_worsen_tails(const Tails& before, double kurtosis_ratio);
/// The memory of their power that shows most, of those that will not worsen the tails if they are
/// followed; none where chance explains it.
std::optional<PowerMemory> memory_of_power(const Innovations& all);

}  // namespace imunoise
