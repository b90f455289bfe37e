#pragma once

#include <span>
#include <vector>

#include "core/estimate/estimators.h"
#include "core/inference/held_out_likelihood.h"
#include "core/support/progress.h"

namespace imunoise::study {

/// Candidates of a choice, fitted to the moments of all replicates and held out part by part.
class Comparisons {
 public:
  /// Without parts the likelihood is left out. `measured` must outlive it.
  Comparisons(std::span<const WaveletVariance> measured, std::vector<BandedPower> parts)
      : measured_(measured), parts_(std::move(parts)) {}

  void add(const std::vector<Model>& models, const Progress& progress = {});
  /// Tries what is near the best: flicker, quantisation noise or a ramp beside its terms, or one of
  /// them in the place of another; from the best of those on again, while the likelihood grows
  /// clearly. Nothing without parts.
  void search_on(const Progress& progress = {});

  const std::vector<Estimate>& fits() const { return fits_; }
  const std::vector<HeldOutFit>& held() const { return held_; }  ///< one a fit, or none

 private:
  std::size_t best() const;
  std::vector<Model> near(const Model& model) const;
  bool is_known(const Model& model) const;

  std::span<const WaveletVariance> measured_;
  std::vector<BandedPower> parts_;
  std::vector<Estimate> fits_;
  std::vector<HeldOutFit> held_;
};

/// What an AR1 with a negative phi may be instead; nothing where the model has none.
std::optional<std::string> quantisation_note(const Model& fitted);

}  // namespace imunoise::study
