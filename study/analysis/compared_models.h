#pragma once

#include <utility>
#include <vector>

#include "core/estimate/estimators.h"
#include "core/inference/held_out_likelihood.h"
#include "core/support/progress.h"

namespace imunoise::study {

/// Candidates of a choice, each fitted to all parts of the data but one and compared on that one.
class Comparisons {
 public:
  /// Without parts there is no likelihood, and candidates are kept as they are.
  Comparisons(std::vector<WaveletVariance> measured, std::vector<BandedPower> parts)
      : measured_(std::move(measured)), parts_(std::move(parts)) {}

  void add(const std::vector<Model>& models, const Progress& progress = {});
  /// Tries what is near the best: flicker, quantisation noise or a ramp beside its terms, or one of
  /// them in the place of another; from the best of those on again, while the likelihood grows
  /// clearly. Nothing without parts.
  void search_on(const Progress& progress = {});

  const std::vector<WaveletVariance>& measured() const { return measured_; }
  const std::vector<Model>& models() const { return models_; }    ///< as they were added
  const std::vector<HeldOutFit>& held() const { return held_; }   ///< one a model, or none
  const HeldOutFit& best() const { return held_[best_place()]; }  ///< Precondition: held()

 private:
  std::size_t best_place() const { return simplest_of_best(held_); }
  std::vector<Model> near(const Model& model) const;
  bool is_known(const Model& model) const;

  std::vector<WaveletVariance> measured_;
  std::vector<BandedPower> parts_;
  std::vector<Model> models_;
  /// Of the moments, where the likelihood of every candidate begins: those of the largest one.
  std::vector<Eigen::MatrixXd> weight_roots_;
  std::vector<HeldOutFit> held_;
};

/// What an AR1 with a negative phi may be instead; nothing where the model has none.
std::optional<std::string> quantisation_note(const Model& fitted);

}  // namespace imunoise::study
