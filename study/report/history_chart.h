#pragma once

#include <optional>

#include "imunoise/v1/catalogue.pb.h"
#include "study/report/documents/document.h"

namespace imunoise::report {

/// A parameter over the days with its intervals, and the range in which the newest raises no alarm.
/// Nothing for fewer than two days. For page figures: both widths.
std::optional<Figure> history_chart(const v1::ParameterHistory& history);

/// "gyro_x: angle random walk", "gyro_x: T of AR1 (2)".
std::string history_title(const v1::ParameterHistory& history);

/// The unit that people know the parameter in, and what makes SI values into it.
struct ShownUnit {
  std::string name;
  double factor = 1.0;
};
ShownUnit shown_unit(const v1::ParameterHistory& history);

}  // namespace imunoise::report
