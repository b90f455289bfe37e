#pragma once

#include <optional>
#include <string>

namespace imunoise {

/// A number of an effect as a report shows it, in SI units, with its interval (95 %).
struct ReportedNumber {
  std::string name;  ///< "frequency_hz", "amplitude"
  double value = 0.0;
  std::string unit;  ///< "1" where it has none
  std::optional<double> lower{};
  std::optional<double> upper{};
};

/// Half of a normal 95 % interval over its standard error.
double interval_reach();
/// With the interval of a standard error; without one where the error is 0 or unknown.
ReportedNumber with_error(ReportedNumber to, double error);
/// The same where the error is that of the number's logarithm.
ReportedNumber with_log_error(ReportedNumber to, double error);

}  // namespace imunoise
