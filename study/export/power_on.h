#pragma once

// What replicates say about the sensor after its next power-on.

#include <Eigen/Core>
#include <cstdint>
#include <string>
#include <vector>

#include "core/model/model.h"
#include "imunoise/v1/noise.pb.h"

namespace imunoise::study {

/// The distribution G(θ0) that replicates draw a parameter from: normal on the parameter's scale
/// (logarithm of a power or a time, logit between the bounds of anything else).
struct ParameterDraw {
  std::size_t term = 0;
  std::size_t parameter = 0;
  double mean = 0.0;    ///< in the parameter's unit
  double spread = 0.0;  ///< standard deviation on its scale: 0.1 means 10 %
  int replicates = 0;   ///< that it was estimated from
  std::string words;  ///< "sigma2 of WN: mean 2.5e-07, between 6 replicates ±9.2 % (5.1 … 24 %)"
};

/// The parameters that differ between replicates at 5 %, of a report on the same model.
std::vector<ParameterDraw> moving_parameters(
    const Model& noise, const google::protobuf::RepeatedPtrField<v1::ParameterSpread>& spread);

/// Allan variance at `samples` that the next power-on exceeds with probability 1 - level, at each
/// averaging time: the quantile over 2,000 draws from Student's t of replicates - 1 degrees of
/// freedom, widened by √(1 + 1/K) for the error of the mean. Parameters are drawn independently.
/// Deterministic.
Eigen::ArrayXd power_on_allan(const Model& noise, const std::vector<ParameterDraw>& draws,
                              const Eigen::ArrayXd& samples, double level);

}  // namespace imunoise::study
