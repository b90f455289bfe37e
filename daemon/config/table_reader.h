#pragma once

// Takes settings out of a table, with a problem for everything that is not as it should be.

#include <cstdint>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "core/support/result.h"
#include "daemon/config/toml_document.h"

namespace imunoise::config {

/// A text and where it stands.
struct PlacedText {
  std::string text;
  Place place;
};

/// A key that was asked for is known; finish() complains of all others. What cannot be taken is
/// absent, and a problem.
class TableReader {
 public:
  /// `name` is the table's own, "schedule" or "device 2"; empty for the whole file. `table`
  /// outlives the reader.
  TableReader(const TomlTable& table, Place place, std::string name,
              std::vector<Problem>& problems);

  bool has(std::string_view key) const { return find(key) != nullptr; }
  /// The key is there, with an empty list.
  bool holds_nothing(std::string_view key) const;
  /// Where a key stands; the table's own place where it is missing.
  Place place_of(std::string_view key) const;

  /// Not empty.
  std::optional<std::string> text(const std::string& key);
  std::optional<bool> flag(const std::string& key);
  std::optional<std::int64_t> integer(const std::string& key, std::int64_t least,
                                      std::int64_t most);
  /// s; of a text such as "2 h".
  std::optional<double> duration(const std::string& key);
  /// Bytes, of a text such as "20 GB".
  std::optional<std::uint64_t> bytes(const std::string& key);
  std::vector<PlacedText> texts(const std::string& key);
  /// The entry as it stands.
  const TomlEntry* table(const std::string& key);
  std::vector<const TomlValue*> tables(const std::string& key);

  /// A problem of this key, or of the table where the key is missing.
  void complain(const std::string& key, const std::string& message);
  void complain_at(Place place, const std::string& key, const std::string& message);
  /// A problem unless the key is there.
  void require(const std::string& key, const std::string& example);
  /// Reports keys that were not read, with the nearest known one.
  void finish();

 private:
  const TomlEntry* find(std::string_view key) const;
  const TomlEntry* ask(const std::string& key);
  template <class Type>
  const Type* as(const std::string& key, std::string_view expected);

  const TomlTable& table_;
  Place place_;
  std::string name_;
  std::vector<Problem>& problems_;
  std::vector<std::string> known_;
};

/// "unknown; did you mean 'length'?", or the names that there are.
std::string unknown_name(std::string_view name, const std::vector<std::string>& known);

}  // namespace imunoise::config
