#pragma once

// JSON written by hand, where no message stands behind it: the one place that escapes its strings.

#include <string>
#include <string_view>
#include <vector>

namespace imunoise {

/// Appends `text` as a JSON string, with its quotes. `text` is UTF-8.
void append_json_string(std::string& out, std::string_view text);
/// The same by itself.
std::string json_string(std::string_view text);

/// Members in order; values are JSON already.
class JsonObject {
 public:
  JsonObject& add(std::string_view name, std::string_view json);
  JsonObject& add_text(std::string_view name, std::string_view text);
  std::string text() const { return "{" + members_ + "}"; }

 private:
  std::string members_;
};

/// "[1,2]"; values are JSON already.
std::string json_array(const std::vector<std::string>& values);

}  // namespace imunoise
