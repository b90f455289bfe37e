#pragma once

// TOML as a plain tree in which everything knows its place. The only one that knows toml++ is the
// source file beside this header.

#include <cstdint>
#include <string>
#include <string_view>
#include <variant>
#include <vector>

#include "daemon/config/problem.h"

namespace imunoise::config {

struct TomlValue;
struct TomlEntry;

/// In the order of the file.
using TomlTable = std::vector<TomlEntry>;
using TomlArray = std::vector<TomlValue>;
/// A date or a time of day, which no setting of ours is.
struct TomlDate {};

struct TomlValue {
  std::variant<std::string, std::int64_t, double, bool, TomlArray, TomlTable, TomlDate> content;
  Place place;
};

struct TomlEntry {
  std::string key;
  Place place;
  TomlValue value;
};

/// What people call a value's type: "a text", "a whole number", ...
std::string_view type_of(const TomlValue& value);

/// The document as one table, or where it is no TOML: of such errors there is only one, the first.
std::variant<TomlTable, Problem> parse_toml(std::string_view text);

}  // namespace imunoise::config
