#pragma once

// How far the axes of a figure reach: fixed ends, or what their layers need.

#include <vector>

#include "study/figure/scale.h"

namespace imunoise::figure {

/// The panels of a figure in groups that share one x-axis: index of the first, and behind the last.
struct Stack {
  std::size_t first = 0;
  std::size_t end = 0;
};
std::vector<Stack> stacks(const std::vector<Panel>& panels);

/// The x-axis of panels that share one: that of the first, and room for the layers of all.
Scale x_scale(const std::vector<Panel>& panels, const Stack& stack);

/// Values decide; intervals stretch the axis as far as leaves the values legible.
Scale y_scale(const Panel& panel);

/// True where a number of any layer has a place.
bool has_numbers(const Panel& panel);

}  // namespace imunoise::figure
