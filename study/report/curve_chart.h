#pragma once

// Curves, dots and bands over a logarithmic axis.

#include <limits>
#include <optional>
#include <string>
#include <vector>

#include "study/report/documents/document.h"
#include "study/report/svg_plot.h"

namespace imunoise::report {

enum class LayerShape { kLine, kDots, kBand };

struct LayerPoint {
  double x = 0.0;
  double y = 0.0;        ///< of a band: its lower edge
  double upper = 0.0;    ///< of a band
  bool outside = false;  ///< a dot that deviates
};

struct Layer {
  LayerShape shape = LayerShape::kLine;
  std::string css_class;  ///< of plot.css: "model", "replicate", "measured", "band"
  std::vector<LayerPoint> points;
};

/// A place on the horizontal axis that is pointed at.
struct CurveMark {
  double x = 0.0;
  std::string text;
};

struct CurveChart {
  std::string title;
  std::string caption;
  std::string x_title;
  std::string y_title;
  bool log_y = false;
  std::vector<Layer> layers;  ///< drawn in this order
  std::vector<CurveMark> marks{};
  std::optional<double> reference{};  ///< a horizontal line
};

/// Points without a place on the axes are left out. Nothing where fewer than two places are left.
std::optional<Figure> curve_figure(const CurveChart& chart);

/// The chart by itself; empty where there is none.
std::string curve_svg(const CurveChart& chart, const SvgOptions& options = {});

}  // namespace imunoise::report
