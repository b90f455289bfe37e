#pragma once

// A database behind plain types: SQLite in a file, or PostgreSQL. SOCI stays behind this header.

#include <cstdint>
#include <filesystem>
#include <functional>
#include <memory>
#include <optional>
#include <string>
#include <string_view>
#include <variant>
#include <vector>

#include "core/support/result.h"

namespace imunoise::catalogue {

/// A cell; empty: null.
using Value = std::variant<std::monostate, std::int64_t, double, std::string>;
using Row = std::vector<Value>;

/// Statements are SQL that both databases know, with placeholders :a, :b, ... in the order of the
/// values. Errors name the database and say what it said. One thread at a time.
class Database {
 public:
  /// "postgresql://dbname=... host=..." (as libpq takes it, in its keyword form), or the path of a
  /// SQLite file, made when missing; ":memory:" for one that is gone with this object.
  static Result<std::unique_ptr<Database>> open(const std::string& where);
  ~Database();
  Database(const Database&) = delete;
  Database& operator=(const Database&) = delete;

  Result<void> execute(std::string_view statement, const std::vector<Value>& values = {});
  Result<std::vector<Row>> query(std::string_view statement, const std::vector<Value>& values = {});
  /// All of the work is done, or, when it fails, nothing of it. Of all programs, one at a time is
  /// in a transaction of the same `lock`. Work that another program disturbed (a deadlock, a row
  /// that was inserted meanwhile, a file that stays locked) is done again, a few times; `again` is
  /// called before.
  Result<void> transaction(const std::function<Result<void>()>& work, const std::string& lock = "",
                           const std::function<void()>& again = {});

  /// The file, where the database is one.
  const std::optional<std::filesystem::path>& file() const;

 private:
  struct Session;
  explicit Database(std::unique_ptr<Session> session);
  std::unique_ptr<Session> session_;
};

/// What a cell holds; zero or nothing for a null.
std::int64_t integer(const Value& value);
double real(const Value& value);
std::string text(const Value& value);

}  // namespace imunoise::catalogue
