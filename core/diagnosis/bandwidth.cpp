#include "core/diagnosis/bandwidth.h"

#include <cmath>
#include <numbers>
#include <optional>

namespace imunoise {
namespace {

// Per sample, where a process has it.
std::optional<double> number_of(const Process& process, Coefficient wanted) {
  for (const DerivedQuantity& one : derived(process, Hertz{1.0})) {
    if (one.coefficient == wanted) return one.value;
  }
  return std::nullopt;
}

// Samples, of noise that does not ring.
std::optional<double> memory_of(const Process& process) {
  if (!hardly_rings(process)) return number_of(process, Coefficient::kCorrelationTime);
  const double damping = *number_of(process, Coefficient::kDampingRatio);
  const double omega = 2.0 * std::numbers::pi * *number_of(process, Coefficient::kFrequency);
  return std::sqrt(1.0 - damping * damping) / (damping * omega);
}

// Of fast noise, where white noise beside it shows first: behind one lag it is still there at half
// the sampling rate, behind two hardly.
double level_of(const Process& fast) {
  const bool twice = std::holds_alternative<Resonance>(fast) || std::holds_alternative<Ar2>(fast);
  return spectrum(fast, twice ? 0.0 : 0.5);
}

}  // namespace

bool hardly_rings(const Process& process) {
  constexpr double kHardly = 0.5;  // of the critical damping
  const std::optional<double> damping = number_of(process, Coefficient::kDampingRatio);
  return damping && *damping > kHardly;
}

bool is_fast(const Process& process) {
  constexpr double kFastest = 20.0;  // samples
  const std::optional<double> memory = memory_of(process);
  return memory && *memory < kFastest;
}

bool is_bandwidth(const Process& one, const Model& noise) {
  constexpr double kLeft = 0.1;
  if (!is_fast(one)) return false;
  double white = 0.0;
  double fast = 0.0;
  for (const Term& term : noise.terms) {
    if (std::holds_alternative<WhiteNoise>(term.process)) white += spectrum(term.process, 0.5);
    if (is_fast(term.process)) fast += level_of(term.process);
  }
  return white < kLeft * fast;
}

}  // namespace imunoise
