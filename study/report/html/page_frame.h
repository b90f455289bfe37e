#pragma once

// What every page of the house is made of, around its own contents.

#include <string>
#include <string_view>
#include <vector>

#include "study/figure/figure.h"

namespace imunoise::report {

/// The page around a report's body: style and script inside, no network. `title` and `brand` are
/// escaped here, `body` is markup.
std::string page_frame(std::string_view title, std::string_view brand, std::string_view body);

/// The page with one more line at its end, escaped here: where it comes from.
std::string with_footer(std::string page, std::string_view text);

/// A figure for desk and phone: the style sheet shows one of the two.
std::string two_widths(const figure::Figure& figure);

/// A cell whose contents are markup already.
std::string markup_cell(std::string_view css_class, std::string_view markup);
/// A cell of text, which is escaped.
std::string cell(std::string_view css_class, std::string_view text);
/// The row of titles of a table, which are escaped.
std::string table_head(const std::vector<std::string>& titles);

}  // namespace imunoise::report
