#pragma once

// A column of times: what it is called, the rate it shows, and the gaps that forbid to use the
// data.

#include <cstddef>
#include <functional>
#include <optional>
#include <span>
#include <string>
#include <string_view>

#include "core/support/result.h"
#include "core/support/units.h"

namespace imunoise::recording {

/// True for the names of time columns: t, time, timestamp (any case), also with _s, _ms, _us, _ns.
bool is_time_name(std::string_view name);

/// Seconds per stored number of a time column. `unit` is what the header states ("" for nothing:
/// then the name's suffix counts). Nothing when neither states a unit. Error: not a unit of time.
Result<std::optional<double>> time_unit(std::string_view name, std::string_view unit);

/// What is known of a time column besides its numbers.
struct TimeColumn {
  std::string_view place;                            ///< For messages: "run.csv: column t".
  std::optional<double> seconds;                     ///< Per stored number, when stated.
  std::function<std::string(std::size_t)> row = {};  ///< Names sample i: "row 17".
};

/// Times that are evenly spaced but for their scatter.
struct EvenTimes {
  Hertz rate;
  double jitter = 0.0;  ///< of single stamps, rms, in periods
};

/// What evenly spaced times show. The rate is the shortest decimal number that the stamps'
/// own scatter allows about (n - 1) / (last - first). Steps are compared with their median, so that
/// a gap cannot hide in the mean. The jitter is that of independent stamps with steps of this
/// scatter.
///
/// Errors, with the row: a time that repeats or goes backwards, a step more than 1.5 or less than
/// 0.5 times the median; fewer than two times; no unit stated and a median step above 1 (it may
/// well be milliseconds). Values must be finite.
Result<EvenTimes> even_times(std::span<const double> times, const TimeColumn& column);

}  // namespace imunoise::recording
