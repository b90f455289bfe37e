#pragma once

// The style of figures, embedded at build time from assets/.

#include <string>
#include <string_view>

namespace imunoise::figure {

extern const std::string_view kPaletteCss;
extern const std::string_view kPlotCss;

/// plot.css with the light palette's colours in place of its variables: figures for papers are read
/// by programs that do not know CSS variables.
std::string plot_style_for_paper();

}  // namespace imunoise::figure
