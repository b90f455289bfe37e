#pragma once

#include <optional>
#include <string>
#include <vector>

#include "study/figure/figure.h"

namespace imunoise::report {

/// A value over a covariate, with its interval; ends that are not finite are unknown.
struct CovariateValue {
  double covariate = 0.0;
  double value = 0.0;
  double lower = 0.0;
  double upper = 0.0;
};

struct CovariateValues {
  std::string title;
  std::string covariate_title;  ///< of the horizontal axis: "rate, deg/s"
  std::string value_title;      ///< of the vertical axis: "N, °/√h"
  std::string caption;
  std::vector<CovariateValue> curve;   ///< by covariate, ascending
  std::vector<CovariateValue> points;  ///< beside the curve
};

/// The curve in its band and the points with whiskers, on linear axes; values begin at zero.
/// Nothing when fewer than two places of the curve are known.
std::optional<figure::Figure> covariate_figure(const CovariateValues& values);

}  // namespace imunoise::report
