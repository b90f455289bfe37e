#pragma once

// Text that comes from files and people, made safe to show: one home for escaping and widths.

#include <cstddef>
#include <string>
#include <string_view>

namespace imunoise::report {

/// U+FFFD, what stands in place of bytes that are no text.
constexpr char32_t kReplacement = 0xFFFD;

/// The code point that starts at byte `at`, which moves behind it; kReplacement for invalid UTF-8.
char32_t next_code_point(std::string_view text, std::size_t& at);

/// Appends a code point as UTF-8.
void append_utf8(std::string& out, char32_t code_point);

/// One line of valid UTF-8: tabs and line breaks become spaces; other control characters (terminal
/// escapes), bidirectional overrides and invalid bytes become U+FFFD.
std::string clean_text(std::string_view text);

/// clean_text with & < > " ' as entities: for HTML and XML, in text and in quoted attributes.
std::string escape_markup(std::string_view text);

/// Columns that `text` takes on a terminal: 2 for wide East Asian characters, 0 for combining ones.
std::size_t display_width(std::string_view text);

/// `text` cut to at most `columns`, the last of them `ellipsis` when something was cut.
std::string shorten(std::string_view text, std::size_t columns, std::string_view ellipsis = "…");

/// The same in ASCII: "°/√h" becomes "deg/sqrt(h)"; what has no spelling becomes '?'.
std::string to_ascii(std::string_view text);

}  // namespace imunoise::report
