#pragma once

// What virtual sensors gain at each averaging time, as a picture for the guides.

#include <Eigen/Core>
#include <string>
#include <vector>

namespace imunoise::testing {

/// One virtual sensor: its wavelet variance relative to the mean of the sensors, one value a scale.
struct GainCurve {
  std::string name;  ///< what it was made for: "short"
  Eigen::ArrayXd predicted;
  Eigen::ArrayXd measured{};        ///< on held-out data; empty for none
  Eigen::ArrayXd measured_error{};  ///< its relative standard error
};

struct GainPanel {
  std::string title;
  std::vector<GainCurve> curves;  ///< over the same scales 1, 2 ..
};

/// Panels side by side, scales to the right, gains upwards (SVG).
std::string gain_figure(const std::string& title, const std::vector<GainPanel>& panels);

}  // namespace imunoise::testing
