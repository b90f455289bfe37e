#pragma once

#include "study/figure/layout.h"
#include "study/figure/svg_writer.h"

namespace imunoise::figure {

/// What lies behind the layers: grid, reference lines and the panel's edges.
void draw_grid(SvgWriter& svg, const PanelPlace& place);

/// Labels and titles of the axes, the panel's title and note. `narrow`: short titles.
void draw_names(SvgWriter& svg, const PanelPlace& place, const Axis& x, bool narrow);

}  // namespace imunoise::figure
