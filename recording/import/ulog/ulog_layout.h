#pragma once

// Where the fields of a logged message lie. Source: PX4, "ULog File Format", section "F: Format
// message".

#include <cstddef>
#include <map>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

namespace imunoise::recording {

/// A field of numbers in a message.
struct UlogField {
  std::string type;  ///< "float", "int16_t", ...
  std::size_t offset = 0;
  std::size_t count = 1;
};

/// The formats of a log. Types may name one another.
class UlogFormats {
 public:
  /// "name:float[3] x;uint64_t timestamp;". Bytes that are no format are passed over.
  void add(std::string_view text);
  /// The field of a message by its name; nothing: there is none, or the format is damaged.
  std::optional<UlogField> find(const std::string& message, std::string_view field) const;

 private:
  struct Member {
    std::string type;
    std::string name;
    std::size_t count = 1;
  };
  std::optional<std::size_t> bytes_of(const std::string& type, int depth) const;

  std::map<std::string, std::vector<Member>, std::less<>> formats_;
};

/// A number of that type, from its first byte on; enough bytes are the caller's care.
double ulog_number(const std::string& type, const char* from);

/// Bytes of a plain type; 0 for others.
std::size_t ulog_width(std::string_view type);

}  // namespace imunoise::recording
