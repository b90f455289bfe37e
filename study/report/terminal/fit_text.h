#pragma once

#include <string>

#include "imunoise/v1/noise.pb.h"
#include "study/words/terminal_style.h"

namespace imunoise::report {

/// A fit for the terminal: the measured points over the model's line, the residuals above and below
/// it, coefficients, parameters and notes. No line exceeds the style's width. Thread-safe.
std::string fit_text(const v1::FitReport& report, const TerminalStyle& style = {});

/// A measured wavelet variance: drawing and table.
std::string wv_text(const v1::WaveletVarianceReport& report, const TerminalStyle& style = {});

}  // namespace imunoise::report
