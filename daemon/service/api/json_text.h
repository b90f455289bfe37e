#pragma once

// JSON out of texts, where no message stands behind it.

#include <string>
#include <string_view>
#include <utility>
#include <vector>

namespace imunoise::service {

std::string quoted(std::string_view text);

/// Members in order; values are JSON already.
class JsonObject {
 public:
  JsonObject& add(std::string_view name, std::string_view json);
  JsonObject& add_text(std::string_view name, std::string_view text);
  std::string text() const { return "{" + members_ + "}"; }

 private:
  std::string members_;
};

std::string json_array(const std::vector<std::string>& values);

}  // namespace imunoise::service
