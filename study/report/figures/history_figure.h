#pragma once

#include <optional>
#include <string>

#include "imunoise/v1/catalogue.pb.h"
#include "study/figure/figure.h"

namespace imunoise::report {

/// A parameter over months: a dot a calibration with its interval, and the range that the newest is
/// expected in. Nothing of fewer than two moments.
std::optional<figure::Figure> history_figure(const v1::ParameterHistory& history);

/// "gyro_x: angle random walk of WN".
std::string history_title(const v1::ParameterHistory& history);

/// The unit that people read a parameter in, and what its SI value is multiplied by.
struct ShownUnit {
  std::string name;
  double factor = 1.0;
};
ShownUnit shown_unit(const v1::ParameterHistory& history);

}  // namespace imunoise::report
