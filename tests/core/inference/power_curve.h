#pragma once

// How often the tests of near-stationarity reject, against how much replicates differ.

#include <cstddef>
#include <string>
#include <vector>

namespace imunoise::testing {

struct PowerPoint {
  double spread = 0.0;  ///< standard deviation between replicates of the logarithm of one power
  // Shares of sets that each test rejects at 5 %.
  double misfit = 0.0;
  double heterogeneity = 0.0;
  double published = 0.0;
  double predicted = 0.0;  ///< of heterogeneity, by theory
};

struct PowerCurve {
  std::string title;   ///< "AR1 + WN"
  std::string moves;   ///< "σ² of WN"
  double error = 0.0;  ///< standard error of the logarithm of that power, the others known
  std::size_t sets = 0;
  std::vector<PowerPoint> points;  ///< by spread, zero first
};

/// The curves side by side, as a picture for the guides (SVG).
std::string power_figure(const std::vector<PowerCurve>& curves);

}  // namespace imunoise::testing
