#pragma once

// What every noise process of the house provides. A process is a small value: copied, compared,
// printed. Its wavelet variance is linear in its first parameter, the power: ν(m) = power ·
// shape(m).

#include <Eigen/Core>
#include <concepts>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "core/support/frequency.h"
#include "core/support/random.h"
#include "core/support/units.h"
#include "core/wavelet/scales.h"
#include "core/wavelet/sum_covariance.h"

namespace imunoise {

/// What a process is called and what it means.
struct ProcessInfo {
  std::string_view name;     ///< in the grammar: "AR1"
  std::string_view title;    ///< plain: "first-order Markov noise"
  std::string_view meaning;  ///< its physical meaning, one sentence
  std::string_view
      structure{};  ///< what the whole number in NAME(3) counts; empty when there is none
};

/// The dimension of a parameter, from which its unit is printed.
enum class Dimension {
  kPower,          ///< unit²
  kPurePerSample,  ///< dimensionless, refers to the sampling interval
  kSeconds,
};

struct ParameterInfo {
  std::string name;          ///< in the grammar: "phi"
  std::string_view meaning;  ///< one phrase
  Dimension dimension = Dimension::kPower;
  double lower = 0.0;  ///< the search keeps to [lower, upper]; a power is only bounded by zero
  double upper = 0.0;
  bool logarithmic = false;  ///< positive parameter, searched on a logarithmic scale
};

/// A quantity people know the process by, derived from its parameters.
struct DerivedQuantity {
  Coefficient coefficient;
  double value;  ///< SI
};

/// Half-widths m of the scales, as numbers ≥ 1.
using HalfWidths = Eigen::Ref<const Eigen::ArrayXd>;

/// What a process carries from one sample to the next: next() gives the next sample of one
/// realisation.
template <class R>
concept NoiseRecursion = std::movable<R> && requires(R r, RandomStream& rng) {
  { r.next(rng) } -> std::same_as<double>;
};

template <class P>
concept NoiseProcess = std::regular<P> &&
    requires(P p, const P c, HalfWidths m, RandomStream& rng) {
  { P::kInfo } -> std::convertible_to<ProcessInfo>;
  { c.parameters() } -> std::same_as<std::vector<ParameterInfo>>;  ///< the power first
  { c.values() } -> std::same_as<std::vector<double>>;             ///< in the same order
  p.set_values(std::span<const double>{});
  { c.shape(m) } -> std::same_as<Eigen::ArrayXd>;            ///< ν(m) / power
  { c.shape_jacobian(m) } -> std::same_as<Eigen::ArrayXXd>;  ///< d shape / d the other parameters
  { c.spectrum(0.1) } -> std::same_as<double>;  ///< two-sided, unit² per cycle/sample, 0 < f ≤ 1/2
  { c.sum_covariance() } -> std::same_as<SumCovariance>;
  { c.derived(Hertz{}) } -> std::same_as<std::vector<DerivedQuantity>>;
  {
    c.scan(Scales{})
    } -> std::same_as<std::vector<std::vector<double>>>;  ///< where to look for the shape
  { c.recursion(rng) } -> NoiseRecursion;  ///< one realisation, from its stationary start
};

/// For processes without shape parameters.
inline Eigen::ArrayXXd no_shape_jacobian(HalfWidths m) { return Eigen::ArrayXXd(m.size(), 0); }

}  // namespace imunoise
