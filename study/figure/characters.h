#pragma once

#include <string>

#include "study/figure/figure.h"
#include "study/words/terminal_style.h"

namespace imunoise::figure {

/// The figure's panels as lines of a terminal, none wider than the style says: lines in braille
/// (ASCII: dots), points as marks, strips of residuals as digits, rows of intervals and cells under
/// their names. Parts of a model and replicates, which no terminal could tell apart, are left out.
/// Title, caption and key are the caller's. Thread-safe.
std::string characters(const Figure& figure, const report::TerminalStyle& style);

}  // namespace imunoise::figure
