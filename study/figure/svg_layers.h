#pragma once

#include "study/figure/layout.h"
#include "study/figure/svg_writer.h"

namespace imunoise::figure {

/// True of layers that lie behind the grid.
bool is_background(const Layer& layer);

/// One layer, as a group that carries its name (data-term) and role, its places with data-x, data-y
/// and data-sigma.
void draw_layer(SvgWriter& svg, const PanelPlace& place, const Layer& layer);

/// A layer's sign in the key, left end and baseline at `at`.
void draw_sign(SvgWriter& svg, const Layer& layer, Point at);

/// The places of a line, in px; those outside the panel as well.
std::vector<Point> line_points(const PanelPlace& place, const Layer& layer);

}  // namespace imunoise::figure
