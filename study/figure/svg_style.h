#pragma once

// The classes of plot.css and the data attributes that layers and their places carry.

#include <string>

#include "study/figure/figure.h"

namespace imunoise::figure {

/// Deviation at which a cell has its full colour, in standard deviations.
constexpr double kFullColour = 6.0;

const char* role_name(Role role);

/// A class and what the state adds: "measured outside".
std::string with_state(const char* css_class, State state);

std::string line_class(const Layer& layer);
const char* area_class(const Layer& layer);
const char* bar_class(const Layer& layer);

/// Sign and strength of a cell: "cell plus3".
std::string cell_class(double sigma);

/// data-x, data-y and data-sigma, those that are known.
std::string data_attributes(const Datum& place);

}  // namespace imunoise::figure
