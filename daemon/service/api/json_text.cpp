#include "daemon/service/api/json_text.h"

#include <fmt/format.h>

namespace imunoise::service {

std::string quoted(std::string_view text) {
  std::string out = "\"";
  for (const char c : text) {
    if (static_cast<unsigned char>(c) < 0x20) {
      out += fmt::format("\\u{:04x}", static_cast<unsigned>(c));
      continue;
    }
    if (c == '"' || c == '\\') out += '\\';
    out += c;
  }
  return out + "\"";
}

JsonObject& JsonObject::add(std::string_view name, std::string_view json) {
  if (!members_.empty()) members_ += ",";
  members_ += fmt::format("{}:{}", service::quoted(name), json);
  return *this;
}

JsonObject& JsonObject::add_text(std::string_view name, std::string_view text) {
  return add(name, service::quoted(text));
}

std::string json_array(const std::vector<std::string>& values) {
  return fmt::format("[{}]", fmt::join(values, ","));
}

}  // namespace imunoise::service
