#include "drivers/can/codec/candump.h"

#include <fmt/format.h>

#include <algorithm>
#include <charconv>

#include "drivers/can/codec/identifier.h"

namespace imunoise::drivers {
namespace {

constexpr std::uint32_t kErrorFlag = 0x2000'0000;

// All of `text` as an unsigned number.
template <class T>
std::optional<T> parse_whole(std::string_view text, int base) {
  T out = 0;
  const char* const end = text.data() + text.size();
  const auto [stop, error] = std::from_chars(text.data(), end, out, base);
  if (text.empty() || error != std::errc() || stop != end) return std::nullopt;
  return out;
}

// "1700000000.000000": up to nine digits of fraction.
std::optional<std::int64_t> parse_time(std::string_view text) {
  const std::size_t dot = text.find('.');
  if (dot == std::string_view::npos) return std::nullopt;
  const std::string_view digits = text.substr(dot + 1);
  if (digits.size() > 9) return std::nullopt;
  const auto seconds = parse_whole<std::uint32_t>(text.substr(0, dot), 10);
  auto fraction = parse_whole<std::uint32_t>(digits, 10);
  if (!seconds || !fraction) return std::nullopt;
  for (std::size_t i = digits.size(); i < 9; ++i) *fraction *= 10;
  return std::int64_t{*seconds} * 1'000'000'000 + *fraction;
}

bool parse_id(std::string_view text, CanFrame& frame) {
  const auto id = parse_whole<std::uint32_t>(text, 16);
  if (!id) return false;
  if (text.size() == 3) {
    frame.id = *id;
    return *id <= kStandardMask;
  }
  if (text.size() != 8) return false;
  frame.error = (*id & kErrorFlag) != 0;
  frame.extended = !frame.error;
  frame.id = *id & kExtendedMask;
  return (*id & ~(kExtendedMask | kErrorFlag)) == 0;
}

// Pairs of hexadecimal digits, with dots between pairs allowed.
bool parse_data(std::string_view text, CanFrame& frame) {
  const std::size_t most = frame.fd ? 64 : 8;
  while (!text.empty()) {
    if (text.front() == '.' && frame.length > 0) text.remove_prefix(1);
    const auto byte = parse_whole<std::uint8_t>(text.substr(0, 2), 16);
    if (text.size() < 2 || !byte || frame.length == most) return false;
    frame.bytes[frame.length++] = *byte;
    text.remove_prefix(2);
  }
  return !frame.fd || is_fd_length(frame.length);
}

// What follows the first '#'.
bool parse_content(std::string_view text, CanFrame& frame) {
  if (text.starts_with('#')) {
    const auto flags = parse_whole<std::uint8_t>(text.substr(1, 1), 16);
    if (!flags || frame.error) return false;
    frame.fd = true;
    frame.fd_flags = *flags;
    return parse_data(text.substr(2), frame);
  }
  if (text.starts_with('R')) {
    if (frame.error) return false;
    frame.remote = true;
    if (text.size() == 1) return true;
    const auto length = parse_whole<std::uint8_t>(text.substr(1), 10);
    if (!length || *length > 8) return false;
    frame.length = *length;
    return true;
  }
  return parse_data(text, frame);
}

// As Linux names interfaces: at most 15 characters, none of them a blank.
bool is_interface(std::string_view text) {
  return !text.empty() && text.size() <= 15 &&
         std::all_of(text.begin(), text.end(), [](char c) { return c > ' ' && c <= '~'; });
}

// The text up to the first space, which is taken off together with it.
std::string_view take_word(std::string_view& text) {
  const std::size_t space = std::min(text.find(' '), text.size());
  const std::string_view out = text.substr(0, space);
  text.remove_prefix(std::min(space + 1, text.size()));
  return out;
}

}  // namespace

std::optional<CandumpLine> parse_candump_line(std::string_view line) {
  std::string_view time = take_word(line);
  if (time.size() < 2 || time.front() != '(' || time.back() != ')') return std::nullopt;
  CandumpLine out;
  const auto time_ns = parse_time(time.substr(1, time.size() - 2));
  if (!time_ns) return std::nullopt;
  out.time_ns = *time_ns;
  out.interface = take_word(line);
  const std::string_view frame = take_word(line);
  const std::size_t hash = frame.find('#');
  if (!is_interface(out.interface) || hash == std::string_view::npos ||
      !parse_id(frame.substr(0, hash), out.frame) ||
      !parse_content(frame.substr(hash + 1), out.frame)) {
    return std::nullopt;
  }
  if (line == "R") {
    out.direction = CanDirection::kReceived;
  } else if (line == "T") {
    out.direction = CanDirection::kSent;
  } else if (!line.empty()) {
    return std::nullopt;
  }
  return out;
}

std::string format_candump_line(const CandumpLine& line) {
  const CanFrame& frame = line.frame;
  std::string out = fmt::format("({}.{:06}) {} ", line.time_ns / 1'000'000'000,
                                line.time_ns % 1'000'000'000 / 1000, line.interface);
  if (frame.error) {
    out += fmt::format("{:08X}#", frame.id | kErrorFlag);
  } else {
    out += frame.extended ? fmt::format("{:08X}#", frame.id) : fmt::format("{:03X}#", frame.id);
  }
  if (frame.remote) out += frame.length > 0 ? fmt::format("R{}", frame.length) : "R";
  if (frame.fd) out += fmt::format("#{:X}", frame.fd_flags);
  for (const std::uint8_t byte : frame.data()) out += fmt::format("{:02X}", byte);
  if (line.direction == CanDirection::kReceived) out += " R";
  if (line.direction == CanDirection::kSent) out += " T";
  return out;
}

}  // namespace imunoise::drivers
