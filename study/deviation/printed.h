#pragma once

// Noise figures as data sheets print them.

#include <string>
#include <string_view>
#include <vector>

#include "core/model/model.h"
#include "core/support/result.h"

namespace imunoise::study {

/// A coefficient that a data sheet prints.
struct PrintedFigure {
  Coefficient coefficient = Coefficient::kRandomWalk;  ///< kRandomWalk, kBiasInstability or
                                                       ///< kRateRandomWalk
  double value = 0.0;                                  ///< SI
  std::string text;                                    ///< "0.3 deg/sqrt(h)"
};

/// Figures of one quantity.
struct PrintedFigures {
  Quantity quantity = Quantity::kUnknown;
  std::vector<PrintedFigure> figures;
};

/// "N=0.3 deg/sqrt(h), B=5 deg/h, K=12 deg/h/sqrt(h)". Symbols N (or ARW, VRW), B (or BI), K (or
/// RRW). Units are those of rates and accelerations over √Hz, √h or √s, with √, sqrt() or "rt":
/// deg/√h, dps/√Hz, (deg/h)/√Hz, m/s/√h, ug/√Hz, ... Error: what cannot be read, or a unit of
/// another quantity.
Result<PrintedFigures> parse_printed(std::string_view text, Quantity quantity);

/// WN, FN and RW of the figures, per sample at a rate. Precondition: at least one figure.
Model printed_model(const PrintedFigures& printed, Hertz rate);

}  // namespace imunoise::study
