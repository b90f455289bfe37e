#include "daemon/config/table_reader.h"

#include <fmt/format.h>

#include <algorithm>
#include <utility>

#include "core/support/nearest_word.h"
#include "daemon/config/quantity_text.h"

namespace imunoise::config {

TableReader::TableReader(const TomlTable& table, Place place, std::string name,
                         std::vector<Problem>& problems)
    : table_(table), place_(place), name_(std::move(name)), problems_(problems) {}

const TomlEntry* TableReader::find(std::string_view key) const {
  const auto at = std::find_if(table_.begin(), table_.end(),
                               [&](const TomlEntry& entry) { return entry.key == key; });
  return at == table_.end() ? nullptr : &*at;
}

const TomlEntry* TableReader::ask(const std::string& key) {
  if (std::find(known_.begin(), known_.end(), key) == known_.end()) known_.push_back(key);
  return find(key);
}

bool TableReader::holds_nothing(std::string_view key) const {
  const TomlEntry* const entry = find(key);
  const auto* const list =
      entry == nullptr ? nullptr : std::get_if<TomlArray>(&entry->value.content);
  return list != nullptr && list->empty();
}

Place TableReader::place_of(std::string_view key) const {
  const TomlEntry* const entry = find(key);
  return entry == nullptr ? place_ : entry->place;
}

void TableReader::complain_at(Place place, const std::string& key, const std::string& message) {
  const std::string dot = name_.empty() || key.empty() ? "" : ".";
  problems_.push_back({place, name_ + dot + key, message});
}

void TableReader::complain(const std::string& key, const std::string& message) {
  complain_at(place_of(key), key, message);
}

void TableReader::require(const std::string& key, const std::string& example) {
  if (!has(key)) complain(key, "is missing; give " + example);
}

template <class Type>
const Type* TableReader::as(const std::string& key, std::string_view expected) {
  const TomlEntry* const entry = ask(key);
  if (entry == nullptr) return nullptr;
  const Type* const content = std::get_if<Type>(&entry->value.content);
  if (content == nullptr) {
    complain_at(entry->value.place, key,
                fmt::format("is {}; give {}", type_of(entry->value), expected));
  }
  return content;
}

std::optional<std::string> TableReader::text(const std::string& key) {
  const auto* const content = as<std::string>(key, "a text, in quotes");
  if (content == nullptr) return std::nullopt;
  if (content->empty()) {
    complain(key, "is empty");
    return std::nullopt;
  }
  return *content;
}

std::optional<bool> TableReader::flag(const std::string& key) {
  const bool* const content = as<bool>(key, "true or false");
  return content == nullptr ? std::nullopt : std::optional(*content);
}

std::optional<std::int64_t> TableReader::integer(const std::string& key, std::int64_t least,
                                                 std::int64_t most) {
  const auto* const content = as<std::int64_t>(key, "a whole number");
  if (content == nullptr) return std::nullopt;
  if (*content < least || *content > most) {
    complain(key, fmt::format("{} is out of bounds; give {} to {}", *content, least, most));
    return std::nullopt;
  }
  return *content;
}

std::optional<double> TableReader::duration(const std::string& key) {
  const auto* const content = as<std::string>(key, "a time with its unit, as \"90 s\" or \"2 h\"");
  if (content == nullptr) return std::nullopt;
  const Result<double> seconds = parse_duration(*content);
  if (seconds) return *seconds;
  complain(key, seconds.error().message);
  return std::nullopt;
}

std::optional<std::uint64_t> TableReader::bytes(const std::string& key) {
  const auto* const content = as<std::string>(key, "a size with its unit, as \"20 GB\"");
  if (content == nullptr) return std::nullopt;
  const Result<std::uint64_t> bytes = parse_bytes(*content);
  if (bytes) return *bytes;
  complain(key, bytes.error().message);
  return std::nullopt;
}

std::vector<PlacedText> TableReader::texts(const std::string& key) {
  const auto* const content = as<TomlArray>(key, "a list of texts, as [\"...\", \"...\"]");
  std::vector<PlacedText> out;
  if (content == nullptr) return out;
  for (const TomlValue& one : *content) {
    if (const auto* const text = std::get_if<std::string>(&one.content)) {
      out.push_back({*text, one.place});
    } else {
      complain_at(one.place, key, fmt::format("contains {}; give texts only", type_of(one)));
    }
  }
  return out;
}

const TomlEntry* TableReader::table(const std::string& key) {
  const bool is_table = as<TomlTable>(key, fmt::format("a table, headed [{}]", key)) != nullptr;
  return is_table ? find(key) : nullptr;
}

std::vector<const TomlValue*> TableReader::tables(const std::string& key) {
  const auto* const content = as<TomlArray>(key, fmt::format("tables, each headed [[{}]]", key));
  std::vector<const TomlValue*> out;
  if (content == nullptr) return out;
  for (const TomlValue& one : *content) {
    if (std::holds_alternative<TomlTable>(one.content)) {
      out.push_back(&one);
    } else {
      complain_at(one.place, key,
                  fmt::format("contains {}; give tables, each headed [[{}]]", type_of(one), key));
    }
  }
  return out;
}

void TableReader::finish() {
  for (const TomlEntry& entry : table_) {
    if (std::find(known_.begin(), known_.end(), entry.key) == known_.end()) {
      complain_at(entry.place, entry.key, unknown_name(entry.key, known_));
    }
  }
}

std::string unknown_name(std::string_view name, const std::vector<std::string>& known) {
  const std::string meant = did_you_mean(name, known);
  if (!meant.empty()) return "unknown; " + meant;
  if (known.empty()) return "unknown; this table has no keys";
  return fmt::format("unknown; known keys: {}", fmt::join(known, ", "));
}

}  // namespace imunoise::config
