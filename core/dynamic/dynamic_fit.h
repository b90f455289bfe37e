#pragma once

#include <optional>
#include <vector>

#include "core/dynamic/free_numbers.h"
#include "core/inference/fit.h"

namespace imunoise {

/// What was measured while the covariate had one value: a wavelet variance for each run of
/// consecutive samples.
struct CovariateBin {
  double covariate = 0.0;  ///< any unit
  std::vector<WaveletVariance> runs;
};

/// The covariate as the model sees it: the middle of the bins' range is 0, its ends are ±1.
struct CovariateAxis {
  double middle = 0.0;
  double half = 1.0;
  double operator()(double covariate) const { return (covariate - middle) / half; }
};

/// How one parameter follows the covariate.
struct TrendEstimate {
  std::size_t term = 0;
  std::size_t parameter = 0;
  Link link = Link::kConstant;
  double slope = 0.0;           ///< b on the scale of the link, per unit of the covariate
  double standard_error = 0.0;  ///< infinite where the data do not show it
  double lower = 0.0;
  double upper = 0.0;
  /// Of b = 0: by how much the objective grows without the trend, the weights held.
  TestOutcome test;
};

struct DynamicFit {
  Model model;  ///< with its slopes; sorted
  CovariateAxis axis;
  Hertz rate;
  double confidence = 0.95;
  double objective = 0.0;  ///< Σ over all runs (ν̂ - ν(θ̂, c))ᵀ Ω (ν̂ - ν(θ̂, c))
  Termination termination = Termination::kLinear;
  /// Each bin by itself; none where it has fewer scales than the model has parameters.
  std::vector<std::optional<Fit>> separate;
  std::vector<TrendEstimate> trends;
  /// Does the shape of the model fit in each bin, with parameters of the bin's own? And in all.
  std::vector<TestOutcome> misfit_in;
  TestOutcome misfit;
  /// Do the bins' own parameters lie on the curves? The score test of what they would explain
  /// beyond the trends.
  TestOutcome links;
  std::vector<FreeNumber> numbers;  ///< that the data can move, and powers at zero
  Eigen::MatrixXd covariance;       ///< of `numbers`
  std::vector<bool> hidden;         ///< numbers that others can imitate
};

/// Dynamic GMWM (Clausen et al. 2018): one model for all bins, whose parameters follow the
/// covariate as their links say. The weights are Ω = V⁻¹, the exact covariance of each run's
/// moments under the fitted model at its covariate. The search starts from the bins' separate fits,
/// regressed on the covariate, and from a scan; no random numbers. Precondition: at least two bins
/// of different covariates, each with at least one run, all of one rate, and a model in which
/// something varies.
DynamicFit fit_dynamic(const Model& open, const std::vector<CovariateBin>& bins,
                       double confidence = 0.95, const Progress& progress = {});

/// What a fit says at a covariate.
struct TermEstimate {
  std::vector<ParameterEstimate> parameters;
  std::vector<DerivedEstimate> derived;
};
/// One a term; pointwise intervals.
std::vector<TermEstimate> estimates_at(const DynamicFit& fit, double covariate);

}  // namespace imunoise
