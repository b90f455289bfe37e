#include "daemon/catalogue/checksums.h"

#include <fmt/format.h>

#include <array>
#include <initializer_list>
#include <map>
#include <string_view>

#include "recording/store/crc32c.h"

namespace imunoise::catalogue {
namespace {

// Everything that the database says of each recording, as one text a recording. SQLite puts it
// together far faster than rows could be fetched.
std::string statement_of_contents(std::string_view condition) {
  const auto part = [](std::string_view table, std::initializer_list<const char*> columns) {
    std::string line = fmt::format("'{}'", table);
    for (const char* const column : columns) line += fmt::format(" || ' ' || quote({})", column);
    return fmt::format("select bench, folder, {} as line from {}", line, table);
  };
  const std::array parts = {
      part("recordings", {"stamp", "campaign", "started_ns", "closed", "fingerprint", "replicates",
                          "samples", "bytes", "trouble"}),
      part("devices", {"name", "id", "driver", "serial"}),
      part("calibrations", {"made_ns", "model", "fingerprint", "channels", "fitted", "troubled",
                            "summary", "trouble"}),
      part("parameters",
           {"device", "stream", "channel", "term", "parameter", "title", "value", "lower_end",
            "upper_end", "unit", "datasheet_unit", "to_datasheet", "model"})};
  return fmt::format(
      "select bench, folder, group_concat(line, ';') from (select * from ({}) {} order by bench, "
      "folder, line) group by bench, folder",
      fmt::join(parts, " union all "), condition);
}

std::string checksum_of(const Row& contents) {
  return recording::crc32c_text(text(contents[0]) + "\n" + text(contents[1]) + "\n" +
                                text(contents[2]));
}

}  // namespace

Result<std::vector<EntryKey>> damaged_entries(Database& database) {
  const auto contents = database.query(statement_of_contents(""));
  if (!contents) return tl::unexpected(contents.error());
  const auto noted = database.query("select bench, folder, checksum from checksums");
  if (!noted) return tl::unexpected(noted.error());
  std::map<EntryKey, std::string> checksums;
  for (const Row& row : *noted) checksums[{text(row[0]), text(row[1])}] = text(row[2]);
  std::vector<EntryKey> out;
  for (const Row& row : *contents) {
    const auto checksum = checksums.extract({text(row[0]), text(row[1])});
    if (checksum.empty() || checksum.mapped() != checksum_of(row))
      out.emplace_back(text(row[0]), text(row[1]));
  }
  for (const auto& [key, checksum] : checksums) out.push_back(key);
  return out;
}

Result<void> seal_entry(Database& database, const std::string& bench, const std::string& folder) {
  if (!database.file()) return {};
  const auto contents = database.query(
      statement_of_contents("where bench = :bench and folder = :folder"), {bench, folder});
  if (!contents) return tl::unexpected(contents.error());
  if (contents->size() != 1) return fail(folder + ": its entry cannot be read back");
  return database.execute("insert into checksums values (:bench, :folder, :checksum)",
                          {bench, folder, checksum_of(contents->front())});
}

}  // namespace imunoise::catalogue
