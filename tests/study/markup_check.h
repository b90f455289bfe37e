#pragma once

// A small reader of markup for tests: enough to see that tags balance and to list elements.

#include <map>
#include <string>
#include <vector>

namespace imunoise::report {

struct Element {
  std::string name;
  std::map<std::string, std::string> attributes;
  std::string text;  ///< Of itself and its children, as written.
};

struct Markup {
  std::string error;  ///< Empty when every tag is closed in order and every '&' begins an entity.
  std::vector<Element> elements;
};

/// Reads markup; void HTML elements (meta) need no closing tag, style and script hold raw text.
Markup read_markup(const std::string& source);

}  // namespace imunoise::report
