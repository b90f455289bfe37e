#pragma once

#include <string>

#include "study/figure/figure.h"

namespace imunoise::figure {

enum class SvgVariant {
  kStandalone,  ///< A file for papers: white background, title and caption, its own style.
  kInline,      ///< Part of a page, which has title, caption and style sheet.
};

struct SvgOptions {
  SvgVariant variant = SvgVariant::kStandalone;
  double width = 900.0;     ///< px, at least 200; below 600 the figure is laid out for phones
  double height = 0.0;      ///< px; 0: as the panels ask for
  std::string css_class{};  ///< of the figure, beside "figure"
};

/// The figure as SVG, without scripts, ids and inline styles, so that a strict content-security
/// policy holds. Layers are groups with data-role and data-term, their places have data-x, data-y
/// and data-sigma; where the figure has a cursor, `.column` rectangles with data-index and data-at
/// (px) lie over the places of its first points, and `.guide` is a line for the pointer. All text
/// is escaped. Thread-safe.
std::string svg(const Figure& figure, const SvgOptions& options = {});

}  // namespace imunoise::figure
