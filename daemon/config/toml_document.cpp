#include "daemon/config/toml_document.h"

#include <toml++/toml.h>

#include <algorithm>
#include <sstream>
#include <utility>

#include "daemon/config/toml_depth.h"

namespace imunoise::config {
namespace {

Place place_of(const toml::source_region& region) {
  return {std::max<std::uint32_t>(region.begin.line, 1),
          std::max<std::uint32_t>(region.begin.column, 1)};
}

TomlValue plain(const toml::node& node);

TomlTable plain_table(const toml::table& table) {
  TomlTable out;
  for (const auto& [key, value] : table) {
    out.push_back({std::string(key.str()), place_of(key.source()), plain(value)});
  }
  std::stable_sort(out.begin(), out.end(), [](const TomlEntry& a, const TomlEntry& b) {
    return std::pair(a.place.line, a.place.column) < std::pair(b.place.line, b.place.column);
  });
  return out;
}

TomlArray plain_array(const toml::array& array) {
  TomlArray out;
  for (const toml::node& one : array) out.push_back(plain(one));
  return out;
}

TomlValue plain(const toml::node& node) {
  TomlValue out{TomlDate{}, place_of(node.source())};
  switch (node.type()) {
    case toml::node_type::string:
      out.content = node.as_string()->get();
      break;
    case toml::node_type::integer:
      out.content = node.as_integer()->get();
      break;
    case toml::node_type::floating_point:
      out.content = node.as_floating_point()->get();
      break;
    case toml::node_type::boolean:
      out.content = node.as_boolean()->get();
      break;
    case toml::node_type::array:
      out.content = plain_array(*node.as_array());
      break;
    case toml::node_type::table:
      out.content = plain_table(*node.as_table());
      break;
    default:
      break;
  }
  return out;
}

}  // namespace

std::string_view type_of(const TomlValue& value) {
  constexpr std::string_view kNames[] = {"a text", "a whole number", "a number", "true or false",
                                         "a list", "a table",        "a date"};
  return kNames[value.content.index()];
}

std::variant<TomlTable, Problem> parse_toml(std::string_view text) {
  if (auto problem = too_deep(text)) return std::move(*problem);
  try {
    return plain_table(toml::parse(text));
  } catch (const toml::parse_error& error) {
    return Problem{place_of(error.source()), "", std::string(error.description())};
  }
}

}  // namespace imunoise::config
