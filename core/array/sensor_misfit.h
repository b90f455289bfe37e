#pragma once

#include <span>
#include <vector>

#include "core/array/latents.h"
#include "core/inference/goodness.h"
#include "core/wavelet/wavelet_covariance.h"

namespace imunoise {

/// Whether the model of an array fits the wavelet variances of each of its sensors: the test of a
/// fit, goodness_of_fit(), of the noise that the model gives that sensor. One a sensor.
std::vector<TestOutcome> sensor_misfits(const ArrayModel& model,
                                        std::span<const WaveletCovariance> replicates);

}  // namespace imunoise
