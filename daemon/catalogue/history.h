#pragma once

#include <string>
#include <vector>

#include "daemon/catalogue/catalogue.h"

namespace imunoise::catalogue {

struct HistoryOptions {
  std::vector<std::string> channels;    ///< by their own names; empty: all
  std::vector<std::string> parameters;  ///< "N", "sigma", "AR1.T", "angle random walk"; empty: all
  double level = 0.01;  ///< chance of a false alarm over all parameters and both tests
};

/// A device's parameters over time, and whether the newest calibration is compatible with those
/// before it (core/inference/parameter_history.h, on the logarithm). Calibrations are compared when
/// an interval is known on both sides and the model is that of the newest one. Error: no parameter
/// of such a name or channel (those known are listed).
Result<v1::History> history_of(const v1::CataloguedDevice& device, Parameters parameters,
                               const HistoryOptions& options = {});

}  // namespace imunoise::catalogue
