#include "drivers/emulator/effects/call_text.h"

#include <fmt/format.h>

#include <algorithm>
#include <cctype>
#include <charconv>

namespace imunoise::emulator {
namespace {

std::string_view trimmed(std::string_view text) {
  const auto blank = [](char c) { return std::isspace(static_cast<unsigned char>(c)) != 0; };
  while (!text.empty() && blank(text.front())) text.remove_prefix(1);
  while (!text.empty() && blank(text.back())) text.remove_suffix(1);
  return text;
}

bool is_name(std::string_view text) {
  return !text.empty() && std::all_of(text.begin(), text.end(), [](unsigned char c) {
    return std::isalnum(c) != 0 || c == '_';
  });
}

std::optional<double> number_of(const std::string& text) {
  double out = 0.0;
  const char* const end = text.data() + text.size();
  const auto [stop, error] = std::from_chars(text.data(), end, out);
  if (error != std::errc() || stop != end) return std::nullopt;
  return out;
}

}  // namespace

Result<CallText> parse_call(std::string_view text) {
  const std::string_view whole = trimmed(text);
  const auto wrong = [&](std::string_view what) {
    return fail(fmt::format("'{}': {}; it is written NAME(KEY=VALUE, ...)", whole, what));
  };
  const std::size_t open = std::min(whole.find('('), whole.size());
  CallText out{std::string(trimmed(whole.substr(0, open))), {}};
  if (!is_name(out.name)) return wrong("no name");
  if (open == whole.size()) return out;
  if (whole.back() != ')') return wrong("no ')' at the end");
  std::string_view rest = trimmed(whole.substr(open + 1, whole.size() - open - 2));
  while (!rest.empty()) {
    const std::size_t comma = std::min(rest.find(','), rest.size());
    const std::string_view one = rest.substr(0, comma);
    const std::size_t sign = std::min(one.find('='), one.size());
    const std::string_view key = trimmed(one.substr(0, sign));
    if (!is_name(key) || sign == one.size()) return wrong("expected KEY=VALUE");
    out.arguments.emplace_back(key, trimmed(one.substr(sign + 1)));
    if (comma + 1 == rest.size()) return wrong("expected KEY=VALUE behind the last ','");
    rest.remove_prefix(std::min(comma + 1, rest.size()));
  }
  return out;
}

Result<std::vector<double>> numbers_of(const CallText& call,
                                       std::span<const NumberParameter> parameters) {
  const auto wrong = [&](const std::string& what) {
    return fail(fmt::format("{}: {}; write {}", call.name, what, usage(call.name, parameters)));
  };
  std::vector<std::optional<double>> given(parameters.size());
  for (const auto& [key, value] : call.arguments) {
    const auto known =
        std::find_if(parameters.begin(), parameters.end(),
                     [key = std::string_view(key)](const auto& p) { return p.name == key; });
    if (known == parameters.end()) return wrong(fmt::format("has no '{}'", key));
    auto& place = given[static_cast<std::size_t>(known - parameters.begin())];
    if (place) return wrong(fmt::format("{} is given twice", key));
    place = number_of(value);
    // Written so that what is not a number is refused too.
    if (!place || !(*place >= known->minimum && *place <= known->maximum)) {
      return wrong(fmt::format("{}={} is not a number from {:g} to {:g}", key, value,
                               known->minimum, known->maximum));
    }
  }
  std::vector<double> out;
  for (std::size_t i = 0; i < parameters.size(); ++i) {
    const auto value = given[i] ? given[i] : parameters[i].by_default;
    if (!value) return wrong(fmt::format("{} is missing", parameters[i].name));
    out.push_back(*value);
  }
  return out;
}

std::string usage(std::string_view name, std::span<const NumberParameter> parameters) {
  std::string out;
  for (const NumberParameter& one : parameters) {
    out += fmt::format("{}{}", out.empty() ? "" : ", ", one.name);
    if (one.by_default) out += fmt::format("={:g}", *one.by_default);
    if (!one.unit.empty()) out += fmt::format(" {}", one.unit);
  }
  return fmt::format("{}({})", name, out);
}

}  // namespace imunoise::emulator
