#pragma once

#include <optional>
#include <string>
#include <vector>

#include "core/array/array_estimate.h"
#include "core/array/virtual_sensor.h"
#include "imunoise/v1/array.pb.h"
#include "study/analysis/arrays/array_series.h"
#include "study/analysis/arrays/array_setup.h"

namespace imunoise::study {

/// The weights of `count` scales that a text names (see ArraySeriesOptions::scales), of sum one.
/// Error: what was expected.
Result<Eigen::VectorXd> scale_weights_of(const std::string& text, std::size_t count);

/// The virtual sensor of a fitted model.
VirtualSensor virtual_sensor_of(const ArrayFit& fit, const Scales& scales,
                                const Eigen::VectorXd& scale_weights, WeightRule rule);

/// Writes the virtual sensor of a fit into the report. `half` is the fit of the first half of the
/// replicates: what it gives is tried on the others. The report names its sensors and its rate
/// already.
void add_virtual_sensor(const ArrayFit& fit, const Measured& measured,
                        const Eigen::VectorXd& scale_weights, const ArraySeriesOptions& options,
                        const std::optional<ArrayFit>& half, v1::ArrayReport& out);

/// Writes one virtual sensor a scale, each quiet at it and half as much at its neighbours: what is
/// given up at long averaging times for short ones. Nothing for weights of Σ|c| = 1, which are
/// slow to find.
void add_trade_offs(const ArrayFit& fit, const Measured& measured,
                    const ArraySeriesOptions& options, const std::optional<ArrayFit>& half,
                    v1::ArrayReport& out);

}  // namespace imunoise::study
