#pragma once

#include <string>

#include "imunoise/v1/diagnosis.pb.h"
#include "study/report/svg_plot.h"

namespace imunoise::report {

/// The measured wavelet variance against the model that was doubted.
std::string before_svg(const v1::DiagnosisReport& report, const SvgOptions& options = {});

/// What the effects of the last rung leave of it, against the noise of that rung.
std::string after_svg(const v1::DiagnosisReport& report, const SvgOptions& options = {});

}  // namespace imunoise::report
