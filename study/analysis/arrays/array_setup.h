#pragma once

#include <string>
#include <string_view>
#include <vector>

#include "core/array/latents.h"
#include "core/model/model.h"
#include "core/support/progress.h"
#include "core/wavelet/wavelet_covariance.h"
#include "study/analysis/series.h"

namespace imunoise::study {

/// Measured cross-covariances, one a replicate.
using Measured = std::vector<WaveletCovariance>;

/// What every analysis of an array starts from.
struct ArraySetup {
  Model model;
  ArrayLayout layout;
  Measured measured;
};

/// The layout of sensors in groups that are given by name; the rest form one. Error: a name that is
/// no sensor's, or in two groups, or groups where the model has no process that they share.
Result<ArrayLayout> layout_of(const std::vector<Series>& sensors,
                              const std::vector<std::vector<std::string>>& groups,
                              const Model& written);

/// Reads the model of an array, finds the groups of its sensors and measures them. `sensors` is one
/// series a sensor, of the same replicates; `groups` names the sensors of each group, the rest form
/// one. Error: fewer than two sensors, sensors of different quantities, a sensor that never
/// changes, a model or group that cannot be read, more free parameters a sensor than scales, or the
/// caller stopped it.
Result<ArraySetup> array_setup(const std::vector<Series>& sensors, std::string_view model,
                               const std::vector<std::vector<std::string>>& groups, int per_octave,
                               const Progress& progress = {});

}  // namespace imunoise::study
