#pragma once

// What the name of a column says of times.

#include <optional>
#include <string>
#include <string_view>

#include "core/support/result.h"

namespace imunoise::recording {

/// True for the names of time columns: t, time, timestamp, header.stamp, ... (any case), also with
/// _s, _ms, _us, _ns.
bool is_time_name(std::string_view name);

/// Seconds per stored number of a time column. `unit` is what the header states ("" for nothing:
/// then the name's suffix counts). Nothing when neither states a unit. Error: not a unit of time.
Result<std::optional<double>> time_unit(std::string_view name, std::string_view unit);

/// The name of a time in seconds without that word ("header.stamp" of "header.stamp.sec"), and of
/// one in nanoseconds ("header.stamp.nanosec"), which may be all of it; none for any other name.
std::optional<std::string> stem_of_seconds(std::string_view name);
std::optional<std::string> stem_of_nanoseconds(std::string_view name);

}  // namespace imunoise::recording
