#include "core/diagnosis/views/strongest_wave.h"

#include <algorithm>
#include <cmath>
#include <numbers>

#include "core/search/evidence.h"
#include "core/search/wave_scores.h"

namespace imunoise {

std::optional<StrongestWave> strongest_wave(const Current& current) {
  using Index = Eigen::Index;
  const Subject& subject = current.subject();
  const std::size_t count = subject.replicates();
  const Index longest = subject.length(current.longest());
  const Index padded = padded_length(2 * longest);
  const AllWaves waves = all_wave_gains(current, padded);
  if (waves.gain.size() == 0) return std::nullopt;
  Index best = 0;
  const double nats = waves.gain.maxCoeff(&best);
  const auto replicates = static_cast<double>(count);
  const double dof = 2.0 * replicates;
  // A wave's score turns by π T/√3 rad per Hz: the spread of time within a replicate.
  const double band = static_cast<double>(waves.gain.size()) / static_cast<double>(padded);
  const Search search{.path =
                          band * std::numbers::pi / std::sqrt(3.0) * static_cast<double>(longest)};
  // The number of upcrossings is Poisson's: none with a probability of exp(-expected).
  const double expected = std::exp(log_p_value(nats, dof, INFINITY, false, search));
  const auto passed = [&](double probability) {
    return gain_needed(-std::log1p(-probability), dof, false, search) / replicates;
  };
  return StrongestWave{.frequency = static_cast<double>(waves.first + best) /
                                    static_cast<double>(padded) * subject.rate.value,
                       .power = nats / replicates,
                       .chance_median = passed(0.5),
                       .chance_limit = passed(0.05),
                       .p_value = -std::expm1(-expected)};
}

}  // namespace imunoise
