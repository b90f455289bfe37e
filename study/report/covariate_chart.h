#pragma once

#include <optional>
#include <string>
#include <vector>

#include "study/report/documents/document.h"

namespace imunoise::report {

/// A value over a covariate, with its interval; ends that are not finite are unknown.
struct ChartPoint {
  double covariate = 0.0;
  double value = 0.0;
  double lower = 0.0;
  double upper = 0.0;
};

struct CovariateChart {
  std::string title;
  std::string covariate_title;  ///< of the horizontal axis: "rate, deg/s"
  std::string value_title;      ///< of the vertical axis: "N, °/√h"
  std::string caption;
  std::vector<ChartPoint> curve;   ///< by covariate, ascending
  std::vector<ChartPoint> points;  ///< beside the curve
};

/// The curve in its band and the points with whiskers, on linear axes that begin at zero; an
/// interval that is far larger than every value is cut at the frame. Nothing when fewer than two
/// places are known. For page figures: both widths.
std::optional<Figure> covariate_figure(const CovariateChart& chart);

/// The same as a picture for papers.
std::string covariate_svg(const CovariateChart& chart);

}  // namespace imunoise::report
