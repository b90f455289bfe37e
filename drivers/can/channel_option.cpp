#include "drivers/can/channel_option.h"

#include <fmt/format.h>

#include <charconv>
#include <optional>
#include <string>
#include <utility>

namespace imunoise::can {
namespace {

// What stands before the first `mark` and behind it; nothing where there is none, or an empty side.
std::optional<std::pair<std::string_view, std::string_view>> split(std::string_view text,
                                                                   char mark) {
  const std::size_t at = text.find(mark);
  if (at == 0 || at == std::string_view::npos || at + 1 == text.size()) return std::nullopt;
  return std::pair(text.substr(0, at), text.substr(at + 1));
}

// "14" or "0xfb00".
std::optional<std::uint64_t> parse_number(std::string_view text) {
  const bool hexadecimal = text.starts_with("0x");
  if (hexadecimal) text.remove_prefix(2);
  std::uint64_t out = 0;
  const char* const end = text.data() + text.size();
  const auto [stop, error] = std::from_chars(text.data(), end, out, hexadecimal ? 16 : 10);
  if (text.empty() || error != std::errc() || stop != end) return std::nullopt;
  return out;
}

bool set_property(std::string_view name, std::string_view value, drivers::ChannelMapping& out) {
  if (name == "unit") {
    out.unit = value;
    return true;
  }
  const auto number = parse_number(value);
  if (name == "invalid") out.invalid_from = number;
  if (name == "last") out.last = number;
  return number && (name == "invalid" || name == "last");
}

}  // namespace

Result<drivers::ChannelMapping> parse_channel_option(std::string_view text) {
  const auto wrong = [&] {
    return fail(
        fmt::format("channel '{}': write NAME=MESSAGE.SIGNAL, and if wanted "
                    ",unit=UNIT,invalid=NUMBER,last=NUMBER behind it",
                    text));
  };
  const std::size_t comma = std::min(text.find(','), text.size());
  const auto name = split(text.substr(0, comma), '=');
  const auto signal = name ? split(name->second, '.') : std::nullopt;
  if (!signal) return wrong();
  drivers::ChannelMapping out;
  out.channel = name->first;
  out.message = signal->first;
  out.signal = signal->second;
  std::string_view rest = text.substr(comma);
  while (!rest.empty()) {
    rest.remove_prefix(1);
    const std::size_t end = std::min(rest.find(','), rest.size());
    const auto property = split(rest.substr(0, end), '=');
    if (!property || !set_property(property->first, property->second, out)) return wrong();
    rest.remove_prefix(end);
  }
  return out;
}

}  // namespace imunoise::can
