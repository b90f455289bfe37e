#pragma once

// What is UTF-8 and what is not: the one place that decides it.

#include <cstddef>
#include <string>
#include <string_view>

namespace imunoise {

/// Bytes of the well-formed UTF-8 sequence at the front of `text` (Unicode, table 3-7); 0 if none
/// begins there. Precondition: `text` is not empty.
std::size_t utf8_sequence(std::string_view text);

bool is_utf8(std::string_view text);

/// `text` as it is where it is UTF-8, else its bytes as characters of Latin-1 ("°", "²"), in which
/// most old files are written.
std::string as_utf8(std::string_view text);

/// `text` with U+FFFD in place of every byte that belongs to no well-formed sequence.
std::string repaired_utf8(std::string_view text);

}  // namespace imunoise
