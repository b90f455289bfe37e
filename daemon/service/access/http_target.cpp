#include "daemon/service/access/http_target.h"

#include <algorithm>
#include <cstdint>
#include <optional>

#include "core/support/utf8.h"

namespace imunoise::service {
namespace {

constexpr std::size_t kLongestTarget = 4096;
constexpr std::size_t kMostSegments = 32;
constexpr std::size_t kMostParameters = 64;

std::optional<unsigned> hex_digit(char c) {
  if (c >= '0' && c <= '9') return static_cast<unsigned>(c - '0');
  if (c >= 'a' && c <= 'f') return static_cast<unsigned>(c - 'a') + 10U;
  if (c >= 'A' && c <= 'F') return static_cast<unsigned>(c - 'A') + 10U;
  return std::nullopt;
}

unsigned byte_at(std::string_view text, std::size_t at) {
  return static_cast<unsigned char>(text[at]);
}

bool printable(std::string_view text) {
  for (std::size_t at = 0; at < text.size();) {
    const std::size_t length = utf8_sequence(text.substr(at));
    const unsigned lead = byte_at(text, at);
    const bool control = lead < 0x20 || lead == 0x7F ||
                         (lead == 0xC2 && length == 2 && byte_at(text, at + 1) < 0xA0);
    if (length == 0 || control) return false;
    at += length;
  }
  return true;
}

// Percent-encoding undone, once; in a query '+' is a blank.
Result<std::string> decode(std::string_view text, bool query) {
  std::string out;
  for (std::size_t i = 0; i < text.size(); ++i) {
    if (text[i] != '%') {
      out += query && text[i] == '+' ? ' ' : text[i];
      continue;
    }
    const auto high = i + 2 < text.size() ? hex_digit(text[i + 1]) : std::nullopt;
    const auto low = i + 2 < text.size() ? hex_digit(text[i + 2]) : std::nullopt;
    if (!high || !low) return fail("the target has a '%' without two hexadecimal digits");
    out += static_cast<char>(*high * 16 + *low);
    i += 2;
  }
  if (!printable(out)) return fail("the target has bytes that are not printable UTF-8");
  return out;
}

Result<std::string> segment_of(std::string_view text) {
  auto out = decode(text, false);
  if (!out) return out;
  if (out->empty()) return fail("the path has an empty segment");
  if (*out == "." || *out == "..") return fail("the path may not hold '.' or '..'");
  if (out->find_first_of("/\\") != std::string::npos)
    return fail("a segment of the path may not hold '/' or '\\', encoded or not");
  return out;
}

// Calls take() with each part between separators. Error: its first.
template <class Take>
Result<void> split(std::string_view text, char separator, const Take& take) {
  for (std::size_t begin = 0; begin <= text.size();) {
    const std::size_t end = std::min(text.find(separator, begin), text.size());
    if (Result<void> done = take(text.substr(begin, end - begin)); !done) return done;
    begin = end + 1;
  }
  return {};
}

Result<void> take_path(std::string_view path, Target& to) {
  if (path.empty()) return {};
  return split(path, '/', [&](std::string_view part) -> Result<void> {
    auto segment = segment_of(part);
    if (!segment) return tl::unexpected(segment.error());
    if (to.segments.size() == kMostSegments) return fail("the path has too many segments");
    to.segments.push_back(std::move(*segment));
    return {};
  });
}

Result<void> take_query(std::string_view query, Target& to) {
  return split(query, '&', [&](std::string_view part) -> Result<void> {
    if (part.empty()) return {};
    const std::size_t equal = std::min(part.find('='), part.size());
    auto name = decode(part.substr(0, equal), true);
    if (!name) return tl::unexpected(name.error());
    auto value = decode(part.substr(std::min(equal + 1, part.size())), true);
    if (!value) return tl::unexpected(value.error());
    if (name->empty()) return fail("the query has a value without a name");
    if (to.query.size() == kMostParameters) return fail("the query has too many parameters");
    to.query.emplace_back(std::move(*name), std::move(*value));
    return {};
  });
}

}  // namespace

Result<Target> parse_target(std::string_view target) {
  if (target.size() > kLongestTarget) return fail("the target is longer than 4096 bytes");
  if (target.empty() || target.front() != '/') return fail("the target must begin with '/'");
  if (target.find('#') != std::string_view::npos) return fail("the target may not hold '#'");
  const std::size_t mark = std::min(target.find('?'), target.size());
  Target out;
  if (auto done = take_path(target.substr(1, mark - 1), out); !done)
    return tl::unexpected(done.error());
  if (mark < target.size()) {
    if (auto done = take_query(target.substr(mark + 1), out); !done)
      return tl::unexpected(done.error());
  }
  return out;
}

}  // namespace imunoise::service
