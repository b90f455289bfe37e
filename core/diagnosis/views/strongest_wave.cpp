#include "core/diagnosis/views/strongest_wave.h"

#include <algorithm>
#include <cmath>
#include <numbers>

#include "core/search/evidence.h"
#include "core/search/wave_scores.h"
#include "core/support/parallel.h"

namespace imunoise {

std::optional<StrongestWave> strongest_wave(const Current& current) {
  using Index = Eigen::Index;
  const Subject& subject = current.subject();
  const std::size_t count = subject.replicates();
  Index shortest = subject.length(0);
  Index longest = shortest;
  for (std::size_t k = 1; k < count; ++k) {
    shortest = std::min(shortest, subject.length(k));
    longest = std::max(longest, subject.length(k));
  }
  const Index padded = padded_length(2 * longest);
  const auto first = static_cast<Index>(
      std::ceil(kFewestPeriods * static_cast<double>(padded) / static_cast<double>(shortest)));
  const Index last = padded / 2 - 1;
  if (first > last) return std::nullopt;
  std::vector<Eigen::ArrayXd> gains(count);
  for_each_index(count, [&](std::size_t k) {
    gains[k] = wave_gains(current, {k, 0, subject.length(k)}, padded).segment(first, last - first);
  });
  for (std::size_t k = 1; k < count; ++k) gains[0] += gains[k];
  Index best = 0;
  const double nats = gains[0].maxCoeff(&best);
  const auto replicates = static_cast<double>(count);
  const double dof = 2.0 * replicates;
  // A wave's score turns by π T/√3 rad per Hz: the spread of time within a replicate.
  const double band = static_cast<double>(last - first) / static_cast<double>(padded);
  const Search search{.path =
                          band * std::numbers::pi / std::sqrt(3.0) * static_cast<double>(longest)};
  // The number of upcrossings is Poisson's: none with a probability of exp(-expected).
  const double expected = std::exp(log_p_value(nats, dof, INFINITY, false, search));
  const auto passed = [&](double probability) {
    return gain_needed(-std::log1p(-probability), dof, false, search) / replicates;
  };
  return StrongestWave{.frequency = static_cast<double>(first + best) /
                                    static_cast<double>(padded) * subject.rate.value,
                       .power = nats / replicates,
                       .chance_median = passed(0.5),
                       .chance_limit = passed(0.05),
                       .p_value = -std::expm1(-expected)};
}

}  // namespace imunoise
