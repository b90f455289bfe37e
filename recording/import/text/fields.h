#pragma once

// The fields of one line of a text table.

#include <string>
#include <string_view>
#include <vector>

namespace imunoise::recording {

/// Fields of `line`, trimmed and unquoted ("" inside quotes is a quote). The delimiter ' ' stands
/// for runs of blanks, also at the ends of the line. Never empty.
std::vector<std::string> split_fields(std::string_view line, char delimiter);

/// A header's fields. With the delimiter ' ' a unit in brackets belongs to the name before it:
/// "gyro_x [deg/s]" is one field.
std::vector<std::string> split_header(std::string_view line, char delimiter);

/// A column's name, and its unit where the header states one.
struct HeaderField {
  std::string name;
  std::string unit;  ///< As written; empty when none is stated.
};

/// Takes "gyro_x [deg/s]" or "gyro_x (deg/s)" apart.
HeaderField parse_header_field(std::string_view text);

}  // namespace imunoise::recording
