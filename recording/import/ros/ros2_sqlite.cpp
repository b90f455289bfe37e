#include <fmt/core.h>
#include <sqlite3.h>

#include <array>
#include <cstdint>
#include <memory>
#include <string>
#include <string_view>

#include "recording/import/packed/chunk.h"
#include "recording/import/ros/imu_messages.h"
#include "recording/import/table/file.h"
#include "recording/import/table/format.h"

// ROS 2 bags in SQLite (rosbag2_storage_sqlite3): the tables topics and messages.

namespace imunoise::recording {
namespace {

constexpr std::string_view kSqliteMagic("SQLite format 3\0", 16);
constexpr std::string_view kPackedMessage = "\x28\xb5\x2f\xfd";  // a frame of zstd

using Database = std::unique_ptr<sqlite3, decltype(&sqlite3_close)>;
using Statement = std::unique_ptr<sqlite3_stmt, decltype(&sqlite3_finalize)>;

std::string_view sqlite_bytes(sqlite3_stmt* row, int column) {
  const void* const begin = sqlite3_column_blob(row, column);
  const auto count = static_cast<std::size_t>(sqlite3_column_bytes(row, column));
  return begin == nullptr ? std::string_view()
                          : std::string_view(static_cast<const char*>(begin), count);
}

class Ros2Database {
 public:
  Ros2Database(const File& file, const ImportOptions& options)
      : name_(file.name()), collector_(file.name(), options) {}

  Result<Table> read(FileProgress& progress) {
    sqlite3* made = nullptr;
    const int opened =
        sqlite3_open_v2(name_.c_str(), &made, SQLITE_OPEN_READONLY | SQLITE_OPEN_NOMUTEX, nullptr);
    const Database database(made, &sqlite3_close);
    if (opened != SQLITE_OK) return trouble(made);
    sqlite3_limit(made, SQLITE_LIMIT_LENGTH, 256 << 20);
    // Views and triggers of a hostile file could run for ever: only tables are read.
    if (const Result<void> plain = each(made,
                                        "SELECT count(*) FROM sqlite_master WHERE type = 'table' "
                                        "AND name IN ('topics', 'messages')",
                                        [&](sqlite3_stmt* row) { return check_tables(row); });
        !plain) {
      return tl::make_unexpected(plain.error());
    }
    const Result<void> topics =
        each(made, "SELECT id, name, type, serialization_format FROM topics",
             [&](sqlite3_stmt* row) -> Result<void> {
               const std::string type(sqlite_bytes(row, 2));
               const std::string_view format = sqlite_bytes(row, 3);
               collector_.topic(static_cast<std::uint64_t>(sqlite3_column_int64(row, 0)),
                                sqlite_bytes(row, 1),
                                format == "cdr" ? type : fmt::format("{} in {}", type, format));
               return {};
             });
    if (!topics) return tl::make_unexpected(topics.error());
    std::size_t rows = 0;
    const Result<void> messages =
        each(made, "SELECT topic_id, timestamp, data FROM messages",
             [&](sqlite3_stmt* row) -> Result<void> {
               if (++rows % 65536 == 0 && progress.stopped()) {
                 return fail(fmt::format("{}: the import was stopped", name_));
               }
               const auto topic = static_cast<std::uint64_t>(sqlite3_column_int64(row, 0));
               if (!collector_.wants(topic)) return {};
               std::string_view data = sqlite_bytes(row, 2);
               Unpacked message;
               if (data.starts_with(kPackedMessage)) {
                 constexpr std::uint64_t largest = std::uint64_t{1} << 16U;  // an Imu has 340 bytes
                 auto unpacked = unpack_chunk("zstd", data, largest);
                 if (unpacked) message = std::move(*unpacked);
                 data = message.bytes;
               }
               collector_.add(topic, Encoding::kCdr, data, sqlite3_column_int64(row, 1));
               return {};
             });
    if (!messages) return tl::make_unexpected(messages.error());
    return collector_.finish();
  }

 private:
  tl::unexpected<Error> trouble(sqlite3* database) const {
    return fail(
        fmt::format("{}: SQLite cannot read it ({}); copy it again, or mend it with "
                    "sqlite3 and .recover",
                    name_, sqlite3_errmsg(database)));
  }

  Result<void> check_tables(sqlite3_stmt* row) const {
    if (sqlite3_column_int(row, 0) == 2) return {};
    return fail(fmt::format(
        "{}: a SQLite file that is no ROS 2 bag (no tables topics and messages)", name_));
  }

  template <class Row>
  Result<void> each(sqlite3* database, const char* query, const Row& row) const {
    sqlite3_stmt* made = nullptr;
    if (sqlite3_prepare_v2(database, query, -1, &made, nullptr) != SQLITE_OK) {
      return trouble(database);
    }
    const Statement statement(made, &sqlite3_finalize);
    int said = SQLITE_ROW;
    while ((said = sqlite3_step(made)) == SQLITE_ROW) {
      const Result<void> done = row(made);
      if (!done) return done;
    }
    if (said != SQLITE_DONE) return trouble(database);
    return {};
  }

  std::string name_;
  ImuCollector collector_;
};

Result<Table> read_ros2_sqlite(const std::filesystem::path& path, const ImportOptions& options,
                               FileProgress& progress) {
  const Result<File> file = File::open(path);
  if (!file) return tl::make_unexpected(file.error());
  // SQLite reads what is there of a truncated file without a word.
  std::array<char, 32> head = {};
  const Result<std::size_t> got = file->read_at(0, head);
  if (!got) return tl::make_unexpected(got.error());
  const auto byte = [&](std::size_t i) {
    return std::uint64_t{static_cast<unsigned char>(head[i])};
  };
  const std::uint64_t stated = byte(16) << 8U | byte(17);
  const std::uint64_t page = stated == 1 ? 65536 : stated;
  const std::uint64_t pages = byte(28) << 24U | byte(29) << 16U | byte(30) << 8U | byte(31);
  if (*got < head.size() || page * pages > file->size()) {
    return fail(fmt::format("{}: is truncated: {} pages of {} bytes are announced; copy it again",
                            file->name(), pages, page));
  }
  return Ros2Database(*file, options).read(progress);
}

Result<bool> claims_ros2_sqlite(const UnknownFile& file) {
  if (file.extension != ".db3") return false;
  return fail(fmt::format("{}: is not a SQLite file, despite its name; copy it again",
                          file.content.name()));
}

}  // namespace

namespace formats {

const ImportFormat& ros2_sqlite() {
  static constexpr ImportFormat kFormat = {
      .kind = "a ROS 2 bag in SQLite (.db3)",
      .begins = [](std::string_view head) { return head.starts_with(kSqliteMagic); },
      .claims = claims_ros2_sqlite,
      .read = read_ros2_sqlite};
  return kFormat;
}

}  // namespace formats

}  // namespace imunoise::recording
