#pragma once

// The figures: the noise budget with its residual strip, and the replicates' residuals as a heat
// map.

#include <string>

#include "study/report/budget_view.h"

namespace imunoise::report {

enum class SvgVariant {
  kStandalone,  ///< A file for papers: white background, title and caption, its own style, no
                ///< script.
  kInline,  ///< Part of the page: colours from its style sheet, columns that the pointer can find.
};

struct SvgOptions {
  SvgVariant variant = SvgVariant::kStandalone;
  double width = 900.0;  ///< px; below 600 the figure is laid out for phones.
  std::string id = "f";  ///< Makes the ids of several figures on one page differ.
};

/// The noise budget: wavelet variance over averaging time, measured (95 % intervals) against the
/// model, its terms and the replicates; below it the residuals in standard deviations. Zeros, gaps
/// and empty reports are drawn as far as a logarithmic axis can show them.
std::string budget_svg(const v1::FitReport& report, const SvgOptions& options = {});

/// One row a replicate, one cell a scale: the residual's sign and size. Empty without replicates.
std::string replicates_svg(const v1::FitReport& report, const SvgOptions& options = {});

/// What the axes of the budget mean, in words.
std::string budget_caption(const v1::FitReport& report);

/// Opening tag, name for screen readers, background and (standalone) style of a figure.
std::string svg_opening(const SvgOptions& options, double height, const std::string& name);

/// A figure of the page, shown in one of its two widths: `kind` is "wide" or "narrow".
std::string of_kind(std::string svg, std::string_view kind);

/// The same for a figure of the page in one of its two widths: `kind` is "wide" or "narrow".
std::string page_opening(const char* kind, double width, double height, const std::string& name);

}  // namespace imunoise::report
