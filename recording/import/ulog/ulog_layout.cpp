#include "recording/import/ulog/ulog_layout.h"

#include <algorithm>
#include <array>
#include <charconv>
#include <cstdint>
#include <cstring>
#include <utility>

namespace imunoise::recording {
namespace {

constexpr int kDeepestType = 8;
constexpr std::size_t kMostFormats = 4096;
constexpr std::size_t kLargestMessage = 65536;  // as the length of a record can say

template <class Number>
double plain(const char* from) {
  Number out;
  std::memcpy(&out, from, sizeof out);
  return static_cast<double>(out);
}

struct PlainType {
  std::string_view name;
  std::size_t width;
  double (*read)(const char* from);
};
constexpr std::array<PlainType, 12> kPlainTypes = {{{"int8_t", 1, plain<std::int8_t>},
                                                    {"uint8_t", 1, plain<std::uint8_t>},
                                                    {"int16_t", 2, plain<std::int16_t>},
                                                    {"uint16_t", 2, plain<std::uint16_t>},
                                                    {"int32_t", 4, plain<std::int32_t>},
                                                    {"uint32_t", 4, plain<std::uint32_t>},
                                                    {"int64_t", 8, plain<std::int64_t>},
                                                    {"uint64_t", 8, plain<std::uint64_t>},
                                                    {"float", 4, plain<float>},
                                                    {"double", 8, plain<double>},
                                                    {"bool", 1, plain<std::uint8_t>},
                                                    {"char", 1, plain<std::uint8_t>}}};

const PlainType* plain_type(std::string_view name) {
  const auto* const found = std::find_if(kPlainTypes.begin(), kPlainTypes.end(),
                                         [&](const PlainType& one) { return one.name == name; });
  return found == kPlainTypes.end() ? nullptr : found;
}

}  // namespace

void UlogFormats::add(std::string_view text) {
  const std::size_t colon = text.find(':');
  if (colon == std::string_view::npos || formats_.size() >= kMostFormats) return;
  std::vector<Member> members;
  std::string_view rest = text.substr(colon + 1);
  while (!rest.empty()) {
    const std::size_t end = rest.find(';');
    const std::string_view one = rest.substr(0, end);
    rest = end == std::string_view::npos ? std::string_view() : rest.substr(end + 1);
    const std::size_t blank = one.find(' ');
    if (blank == std::string_view::npos) continue;
    std::string_view type = one.substr(0, blank);
    Member member{"", std::string(one.substr(blank + 1)), 1};
    const std::size_t bracket = type.find('[');
    if (bracket != std::string_view::npos) {
      const char* const number = type.data() + bracket + 1;
      std::from_chars(number, type.data() + type.size(), member.count);
      type = type.substr(0, bracket);
    }
    member.type = type;
    members.push_back(std::move(member));
  }
  formats_.try_emplace(std::string(text.substr(0, colon)), std::move(members));
}

std::optional<std::size_t> UlogFormats::bytes_of(const std::string& type, int depth) const {
  if (const PlainType* const one = plain_type(type)) return one->width;
  const auto found = formats_.find(type);
  if (found == formats_.end() || depth == kDeepestType) return std::nullopt;
  std::size_t out = 0;
  for (const Member& member : found->second) {
    const auto each = bytes_of(member.type, depth + 1);
    if (!each || member.count > kLargestMessage) return std::nullopt;
    out += *each * member.count;
    if (out > kLargestMessage) return std::nullopt;
  }
  return out;
}

std::optional<UlogField> UlogFormats::find(const std::string& message,
                                           std::string_view field) const {
  const auto found = formats_.find(message);
  if (found == formats_.end()) return std::nullopt;
  std::size_t offset = 0;
  for (const Member& member : found->second) {
    const auto each = bytes_of(member.type, 0);
    if (!each || member.count > kLargestMessage) return std::nullopt;
    if (member.name == field)
      return plain_type(member.type) != nullptr
                 ? std::optional(UlogField{member.type, offset, member.count})
                 : std::nullopt;
    offset += *each * member.count;
    if (offset > kLargestMessage) return std::nullopt;
  }
  return std::nullopt;
}

double ulog_number(const std::string& type, const char* from) {
  return plain_type(type)->read(from);
}

std::size_t ulog_width(std::string_view type) {
  const PlainType* const found = plain_type(type);
  return found == nullptr ? 0 : found->width;
}

}  // namespace imunoise::recording
