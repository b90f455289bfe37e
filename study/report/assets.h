#pragma once

// The page's text assets, embedded at build time from assets/.

#include <cstddef>
#include <string>
#include <string_view>

namespace imunoise::report {

extern const std::string_view kPaletteCss;
extern const std::string_view kPlotCss;
extern const std::string_view kPageCss;
extern const std::string_view kPageJs;

/// Line styles that plot.css has for terms: .term-0 to .term-5.
constexpr std::size_t kTermStyles = 6;

/// plot.css with the light palette's colours in place of its variables: figures for papers are read
/// by programs that do not know CSS variables.
std::string plot_style_for_paper();

}  // namespace imunoise::report
