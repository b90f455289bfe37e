#pragma once

// Rows that name each of their numbers, as serial plotters print them: "ax:0.01,ay:-0.02".

#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "recording/import/text/text_layout.h"

namespace imunoise::recording {

/// A row taken apart; as many labels as values.
struct LabelledRow {
  std::vector<std::string> labels;
  std::vector<std::string> values;
};

/// Words before ':' or '=' are labels; what follows up to the next one, without blanks and
/// separators at its end, is the value. Nothing where a row does not begin with a label.
std::optional<LabelledRow> take_labels(std::string_view row);

/// The values of a row of these labels, separated by tabs; of any other row the row itself.
std::string without_labels(std::string_view row, const std::vector<std::string>& labels);

/// If nearly all rows have the same labels, two or more: drops what comes before the first of them,
/// makes them a row of names, and takes them out of the others. Returns the labels.
std::vector<std::string> name_by_labels(std::vector<TextHead::Row>& rows);

}  // namespace imunoise::recording
