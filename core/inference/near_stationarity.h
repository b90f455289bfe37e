#pragma once

#include <cstdint>
#include <optional>
#include <span>
#include <vector>

#include "core/inference/fit.h"
#include "core/inference/spread.h"

namespace imunoise {

/// A test by its asymptotic distribution, and by a parametric bootstrap where one was asked for:
/// p = (1 + #{T* ≥ T}) / (1 + B).
struct BootstrappedTest {
  TestOutcome asymptotic;
  std::optional<double> bootstrap_p_value;
  /// The p-value to go by.
  double p_value() const { return bootstrap_p_value.value_or(asymptotic.p_value); }
};

/// Is a set of replicates near-stationary, that is, one model with the same parameters in each? Two
/// questions that the published test answers as one:
///   misfit:        does the shape fit every replicate, each with parameters of its own?
///   heterogeneity: do the parameters differ between replicates by more than chance?
struct NearStationarity {
  Estimate pooled;                 ///< MuGMWM with full weights
  std::vector<Estimate> separate;  ///< each replicate by itself, with the pooled weights
  BootstrappedTest misfit;
  BootstrappedTest heterogeneity;
  /// The single statistic of Radi et al. 2019 (the MuGMWM objective with diagonal weights), which a
  /// misfit moves as much as heterogeneity does; its distribution is known by bootstrap only.
  double published_statistic = 0.0;
  std::optional<double> published_p_value;
  std::vector<ParameterSpread> spread;  ///< G(θ0), a row a free parameter
};

struct BootstrapOptions {
  int sets = 0;  ///< B; 0 for none
  std::uint64_t seed = 1;
};

/// Needs at least two replicates. Heterogeneity is the score test at the pooled estimate: what
/// parameters of each replicate's own would explain of its normalised residuals beyond what common
/// ones do, Σ_k s_kᵀI_k⁻s_k - sᵀI⁻s, with Σ rank I_k - rank I degrees of freedom. A bootstrap draws
/// moments (not samples) from the pooled model and repeats the whole estimation with the weights
/// held; its answer depends on the seed only, not on the number of threads.
NearStationarity near_stationarity(const Model& model, std::span<const WaveletVariance> replicates,
                                   const BootstrapOptions& options = {},
                                   const Progress& progress = {});

}  // namespace imunoise
