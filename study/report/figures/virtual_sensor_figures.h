#pragma once

#include <optional>

#include "imunoise/v1/array.pb.h"
#include "study/figure/figure.h"

namespace imunoise::report {

/// Wavelet variance of the virtual sensor over that of the sensors' mean, over averaging time: by
/// the model, and measured on held-out replicates. Nothing without averaging times.
std::optional<figure::Figure> gain_figure(const v1::VirtualSensor& sensor);

/// Its weights with 95 % intervals, a row a sensor. Nothing without sensors.
std::optional<figure::Figure> weights_figure(const v1::VirtualSensor& sensor);

/// The correlation of each shared process between two sensors, with its interval. Nothing where no
/// process is shared.
std::optional<figure::Figure> correlations_figure(const v1::ArrayReport& report);

}  // namespace imunoise::report
