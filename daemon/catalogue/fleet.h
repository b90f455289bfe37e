#pragma once

// All devices of one type side by side.

#include <string>
#include <utility>
#include <vector>

#include "daemon/catalogue/catalogue.h"
#include "imunoise/v1/fleet.pb.h"

namespace imunoise::catalogue {

/// Beyond so many robust standard deviations of the logarithm a device stands out,
inline constexpr double kOutlierReach = 3.5;
/// if so many devices are compared.
inline constexpr std::uint32_t kLeastFleet = 5;

struct FleetOptions {
  std::string type{};                     ///< driver of the devices; empty: the first of all
  std::vector<std::string> channels{};    ///< by their own names; empty: all
  std::vector<std::string> parameters{};  ///< as HistoryOptions has them
};

/// A device with what its calibrations said.
using DeviceParameters = std::pair<v1::CataloguedDevice, Parameters>;

/// The newest calibration of each device of a type, parameter by parameter. Median and quartiles
/// are those of the logarithms of values with an interval on both sides. A device is an outlier
/// where its logarithm lies kOutlierReach robust standard deviations (1.4826 times the median
/// absolute deviation) from the median of at least kLeastFleet devices, and its interval lies
/// outside of the quartiles. Error: no such type (those known are listed), channel or parameter.
Result<v1::Fleet> fleet_of(const std::vector<DeviceParameters>& devices,
                           const FleetOptions& options = {});

}  // namespace imunoise::catalogue
