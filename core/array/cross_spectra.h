#pragma once

#include <Eigen/Core>
#include <vector>

#include "core/array/latents.h"

namespace imunoise {

/// Cross spectra of an array's model at given frequencies (cycles per sample), which borrow the
/// model: one I × I matrix a frequency, unit² per cycle/sample.
class CrossSpectra {
 public:
  CrossSpectra(const ArrayModel& model, const Frequencies& frequency) : model_(model) {
    for (const Latent& latent : model.latents)
      spectra_.push_back(spectrum(latent.term.process, frequency));
  }

  Eigen::MatrixXd operator()(Eigen::Index at) const {
    Eigen::MatrixXd out = Eigen::MatrixXd::Zero(model_.sensors, model_.sensors);
    for (std::size_t t = 0; t < spectra_.size(); ++t)
      out += spectra_[t](at) * model_.latents[t].power;
    return out;
  }

 private:
  const ArrayModel& model_;
  std::vector<Eigen::ArrayXd> spectra_;
};

}  // namespace imunoise
