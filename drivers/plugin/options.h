#pragma once

// What the user chose, as a driver asks for it.

#include <cstdint>
#include <stdexcept>
#include <string>
#include <string_view>
#include <vector>

#include "drivers/driver.h"

namespace imunoise::plugin {

/// Values of the options that the driver described, checked and with defaults filled in. Asking for
/// a value that is absent, or by another type, is a programming error (std::logic_error).
class Options {
 public:
  Options(const imunoise_option_value* const* values, std::uint32_t count)
      : values_(values, values + count) {}

  /// True where the user gave the option, or it has a default.
  bool has(std::string_view name) const { return find(name) != nullptr; }
  bool flag(std::string_view name) const { return get(name, IMUNOISE_OPTION_FLAG).integer != 0; }
  std::int64_t integer(std::string_view name) const {
    return get(name, IMUNOISE_OPTION_INTEGER).integer;
  }
  double number(std::string_view name) const { return get(name, IMUNOISE_OPTION_NUMBER).number; }
  std::string text(std::string_view name) const { return get(name, IMUNOISE_OPTION_TEXT).text; }
  /// All values of a repeated option, in the user's order; none where it was not given.
  std::vector<std::string> texts(std::string_view name) const {
    std::vector<std::string> out;
    for (const imunoise_option_value* const value : values_) {
      if (value->name == name && value->type == IMUNOISE_OPTION_TEXT) out.emplace_back(value->text);
    }
    return out;
  }

 private:
  const imunoise_option_value* find(std::string_view name) const {
    for (const imunoise_option_value* const value : values_) {
      if (value->name == name) return value;
    }
    return nullptr;
  }
  const imunoise_option_value& get(std::string_view name, std::uint32_t type) const {
    const imunoise_option_value* const value = find(name);
    if (value == nullptr || value->type != type) {
      throw std::logic_error("option " + std::string(name) +
                             " was asked for, but is absent or of another type");
    }
    return *value;
  }

  std::vector<const imunoise_option_value*> values_;
};

}  // namespace imunoise::plugin
