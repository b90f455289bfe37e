#include "drivers/host/option_values.h"

#include <fmt/format.h>

#include <algorithm>
#include <charconv>
#include <cmath>
#include <optional>

#include "core/support/nearest_word.h"
#include "core/support/utf8.h"

namespace imunoise::drivers {
namespace {

template <class Number>
std::optional<Number> parse_number(std::string_view text) {
  Number out{};
  const auto [end, error] = std::from_chars(text.data(), text.data() + text.size(), out);
  if (error != std::errc{} || end != text.data() + text.size()) return std::nullopt;
  return out;
}

std::string with_unit(double value, const Option& option) {
  return option.unit.empty() ? fmt::format("{}", value) : fmt::format("{} {}", value, option.unit);
}

Result<void> check_bounds(const Option& option, double value) {
  if (value >= option.minimum && value <= option.maximum) return {};
  const std::string allowed =
      std::isinf(option.maximum) ? "at least " + with_unit(option.minimum, option)
      : std::isinf(option.minimum)
          ? "at most " + with_unit(option.maximum, option)
          : fmt::format("from {} to {}", option.minimum, with_unit(option.maximum, option));
  return fail(fmt::format("{} is out of bounds; give {}", with_unit(value, option), allowed));
}

// The value as the driver gets it; its text is set by the caller.
Result<imunoise_option_value> parse_value(const Option& option, std::string_view text) {
  imunoise_option_value out = {};
  out.size = sizeof out;
  out.type = static_cast<std::uint32_t>(option.type);
  Result<void> sound;
  switch (option.type) {
    case OptionType::kFlag:
      if (text != "true" && text != "false") {
        return fail(fmt::format("'{}' is neither true nor false", text));
      }
      out.integer = text == "true" ? 1 : 0;
      break;
    case OptionType::kInteger: {
      const auto value = parse_number<std::int64_t>(text);
      if (!value) return fail(fmt::format("'{}' is not a whole number", text));
      out.integer = *value;
      sound = check_bounds(option, static_cast<double>(*value));
      break;
    }
    case OptionType::kNumber: {
      const auto value = parse_number<double>(text);
      if (!value || !std::isfinite(*value)) return fail(fmt::format("'{}' is not a number", text));
      out.number = *value;
      sound = check_bounds(option, *value);
      break;
    }
    case OptionType::kText:
      if (!is_utf8(text)) {
        return fail(fmt::format("'{}' is not UTF-8; write it in UTF-8, or rename the file",
                                repaired_utf8(text)));
      }
      if (text.find('\0') != std::string_view::npos) {
        return fail("contains a NUL character; remove it");
      }
      if (!option.choices.empty() &&
          std::find(option.choices.begin(), option.choices.end(), text) == option.choices.end()) {
        return fail(fmt::format("'{}' is none of: {}", text, fmt::join(option.choices, ", ")));
      }
      break;
  }
  if (!sound) return tl::make_unexpected(sound.error());
  return out;
}

std::string names(const std::vector<Option>& options) {
  std::string out;
  for (const Option& option : options) out += (out.empty() ? "" : ", ") + option.name;
  return out.empty() ? "none" : out;
}

}  // namespace

Result<OptionText> parse_option(std::string_view text) {
  const std::size_t at = text.find('=');
  if (at == std::string_view::npos || at == 0) {
    return fail(fmt::format("'{}' is not an option; write NAME=VALUE", text));
  }
  return OptionText{std::string(text.substr(0, at)), std::string(text.substr(at + 1))};
}

Result<void> check_value(const Option& option, std::string_view value) {
  const Result<imunoise_option_value> parsed = parse_value(option, value);
  if (!parsed) return tl::make_unexpected(parsed.error());
  return {};
}

Result<void> OptionValues::add(const Option& option, const std::string& text) {
  Result<imunoise_option_value> value = parse_value(option, text);
  if (!value) return fail(fmt::format("option {}: {}", option.name, value.error().message));
  const OptionText& kept = texts_.emplace_back(OptionText{option.name, text});
  value->name = kept.name.c_str();
  value->text = kept.value.c_str();
  pointers_.push_back(&values_.emplace_back(*value));
  return {};
}

Result<OptionValues> OptionValues::make(const std::vector<Option>& options,
                                        std::span<const OptionText> chosen) {
  for (const OptionText& choice : chosen) {
    const auto same = [&](const Option& option) { return option.name == choice.name; };
    if (std::none_of(options.begin(), options.end(), same)) {
      std::vector<std::string> known;
      for (const Option& one : options) known.push_back(one.name);
      const std::string meant = did_you_mean(choice.name, known);
      return fail(fmt::format("no option {}; it has: {}{}", choice.name, names(options),
                              meant.empty() ? "" : "; " + meant));
    }
  }
  OptionValues out;
  for (const Option& option : options) {
    std::vector<std::string> values;
    for (const OptionText& choice : chosen) {
      if (choice.name == option.name) values.push_back(choice.value);
    }
    if (values.size() > 1 && !option.repeated) {
      return fail(
          fmt::format("option {}: given {} times; give it once", option.name, values.size()));
    }
    if (values.empty() && option.required) {
      return fail(fmt::format("option {} is missing: {}; give {}=...", option.name,
                              option.description, option.name));
    }
    if (values.empty() && option.by_default) values.push_back(*option.by_default);
    for (const std::string& value : values) {
      const Result<void> added = out.add(option, value);
      if (!added) return tl::make_unexpected(added.error());
    }
  }
  return out;
}

}  // namespace imunoise::drivers
