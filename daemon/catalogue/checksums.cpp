#include "daemon/catalogue/checksums.h"

#include <fmt/format.h>

#include <array>
#include <map>
#include <string_view>

#include "recording/store/format/crc32c.h"

namespace imunoise::catalogue {
namespace {

// A row as text, in each table. SQLite puts it together far faster than its cells could be fetched;
// what may be null says so, since a null prints as a zero.
constexpr std::array kRows = {
    std::pair("recordings",
              "printf('%s|%s|%s|%s|%s|%s|%s|%s|%s', stamp, campaign, started_ns, closed, "
              "fingerprint, replicates, samples, bytes, trouble)"),
    std::pair("devices", "printf('%s|%s|%s|%s', name, id, driver, serial)"),
    std::pair("calibrations",
              "printf('%s|%s|%s|%s|%s|%s|%s|%s', made_ns, model, fingerprint, channels, fitted, "
              "troubled, summary, trouble)"),
    std::pair("parameters",
              "printf('%s|%s|%s|%s|%s|%s|%!.20g|%!.20g|%s|%!.20g|%s|%s|%s|%!.20g|%s', device, "
              "stream, channel, term, parameter, title, value, lower_end, typeof(lower_end), "
              "upper_end, typeof(upper_end), unit, datasheet_unit, to_datasheet, model)"),
};

using Contents = std::map<EntryKey, std::string>;

// Everything that the database says of each recording.
Result<Contents> contents_of(Database& database, std::string_view condition,
                             const std::vector<Value>& values) {
  Contents out;
  for (const auto& [table, line] : kRows) {
    const auto rows = database.query(
        fmt::format("select bench, folder, group_concat({}, ';') from {} {} group by bench, folder",
                    line, table, condition),
        values);
    if (!rows) return tl::unexpected(rows.error());
    for (const Row& row : *rows)
      out[{text(row[0]), text(row[1])}] += fmt::format("{} {}\n", table, text(row[2]));
  }
  return out;
}

std::string checksum_of(const EntryKey& key, const std::string& contents) {
  return recording::crc32c_text(key.first + "\n" + key.second + "\n" + contents);
}

}  // namespace

Result<std::vector<EntryKey>> damaged_entries(Database& database) {
  const auto contents = contents_of(database, "", {});
  if (!contents) return tl::unexpected(contents.error());
  const auto noted = database.query("select bench, folder, checksum from checksums");
  if (!noted) return tl::unexpected(noted.error());
  std::map<EntryKey, std::string> checksums;
  for (const Row& row : *noted) checksums[{text(row[0]), text(row[1])}] = text(row[2]);
  std::vector<EntryKey> out;
  for (const auto& [key, one] : *contents) {
    const auto checksum = checksums.extract(key);
    if (checksum.empty() || checksum.mapped() != checksum_of(key, one)) out.push_back(key);
  }
  for (const auto& [key, checksum] : checksums) out.push_back(key);
  return out;
}

Result<void> seal_entry(Database& database, const std::string& bench, const std::string& folder) {
  if (!database.file()) return {};
  const auto contents =
      contents_of(database, "where bench = :bench and folder = :folder", {bench, folder});
  if (!contents) return tl::unexpected(contents.error());
  const EntryKey key(bench, folder);
  const auto found = contents->find(key);
  if (found == contents->end()) return fail(folder + ": its entry cannot be read back");
  return database.execute("insert into checksums values (:bench, :folder, :checksum)",
                          {bench, folder, checksum_of(key, found->second)});
}

}  // namespace imunoise::catalogue
