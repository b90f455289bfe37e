#pragma once

// Rows of a terminal that are a line each: digits of residuals, rows with a name, labels of an
// axis.

#include <string>

#include "study/figure/scale.h"
#include "study/words/terminal_style.h"

namespace imunoise::figure {

/// One digit a place, its size in standard deviations; where places share a column the largest is
/// kept. Those above zero, or those below.
std::string digit_row(const Panel& panel, const Scale& x, int columns, bool above,
                      const report::TerminalStyle& style);

/// What the layers hold in a row of categories: intervals with their dots, bars, or cells as signed
/// digits.
std::string category_row(const Panel& panel, const Scale& x, std::size_t row, int columns,
                         const report::TerminalStyle& style);

/// Labels under an axis, as many as fit.
std::string tick_row(const Scale& x, int columns, const report::TerminalStyle& style);

}  // namespace imunoise::figure
