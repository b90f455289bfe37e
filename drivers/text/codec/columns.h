#pragma once

// What the fields of a row of text are.

#include <cstdint>
#include <string>
#include <string_view>
#include <vector>

#include "core/support/result.h"

namespace imunoise::text {

enum class ColumnRole {
  kValue,       ///< a channel
  kTime,        ///< the device's clock; several are added, such as seconds and nanoseconds
  kCounter,     ///< counts samples
  kPassedOver,  ///< not recorded
};

struct Column {
  ColumnRole role = ColumnRole::kValue;
  std::string name;              ///< of a channel
  std::string unit = "1";        ///< of a channel
  std::int64_t nanoseconds = 0;  ///< of a time column's unit
  friend bool operator==(const Column&, const Column&) = default;
};

/// Reads "time[ms],gyro_x[deg/s],-,counter": units in [] or (), "-" for what is not recorded.
/// Error: no channel, a name twice, a time without a unit of s, ms, us or ns, or what is no name.
Result<std::vector<Column>> parse_columns(std::string_view text);
/// The same of the fields of a header line.
Result<std::vector<Column>> parse_columns(const std::vector<std::string_view>& fields);

/// How fields are told apart.
enum class Separator { kComma, kSemicolon, kSpace };
/// Of a line: the first of ; and , that is in it, else spaces and tabs.
Separator separator_of(std::string_view line);
/// The fields, without spaces around them. Several spaces are one where they separate.
std::vector<std::string_view> split(std::string_view line, Separator separator);

/// Every field is a word rather than a number.
bool is_header(const std::vector<std::string_view>& fields);

}  // namespace imunoise::text
