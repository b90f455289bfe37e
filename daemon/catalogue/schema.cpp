#include "daemon/catalogue/schema.h"

#include <fmt/format.h>

#include <array>

namespace imunoise::catalogue {
namespace {

constexpr std::array kTables = {"recordings", "devices", "calibrations", "parameters", "checksums"};

// A recording is known by its bench and its folder; what was said of it goes with it. The types are
// those that SOCI knows in both databases.
constexpr std::array kStatements = {
    "create table recordings (bench text not null, folder text not null, stamp text not null, "
    "campaign text not null, started_ns bigint not null, closed bigint not null, "
    "fingerprint text not null, replicates bigint not null, samples bigint not null, "
    "bytes bigint not null, trouble text not null, primary key (bench, folder))",
    "create table devices (bench text not null, folder text not null, name text not null, "
    "id text not null, driver text not null, serial text not null, "
    "primary key (bench, folder, name))",
    "create table calibrations (bench text not null, folder text not null, "
    "made_ns bigint not null, model text not null, fingerprint text not null, "
    "channels bigint not null, fitted bigint not null, troubled bigint not null, "
    "summary text not null, trouble text not null, primary key (bench, folder))",
    "create table parameters (bench text not null, folder text not null, device text not null, "
    "stream text not null, channel text not null, term text not null, parameter text not null, "
    "title text not null, value double precision not null, lower_end double precision, "
    "upper_end double precision, unit text not null, datasheet_unit text not null, "
    "to_datasheet double precision not null, model text not null, "
    "primary key (bench, folder, device, stream, channel, term, parameter))",
    "create index parameters_of_device on parameters (device)",
    "create table checksums (bench text not null, folder text not null, checksum text not null, "
    "primary key (bench, folder))",
};

Result<void> make_anew(Database& database) {
  for (const char* const table : kTables) {
    auto done = database.execute(fmt::format("drop table if exists {}", table));
    if (!done) return done;
  }
  for (const char* const statement : kStatements) {
    if (auto done = database.execute(statement); !done) return done;
  }
  if (auto done = database.execute("delete from imunoise_schema"); !done) return done;
  return database.execute("insert into imunoise_schema values (:version)", {kSchemaVersion});
}

}  // namespace

Result<void> prepare_schema(Database& database) {
  // Nothing is locked where everything is ready; in a new database this fails.
  const auto ready = database.query("select version from imunoise_schema");
  if (ready && ready->size() == 1 && integer(ready->front().front()) == kSchemaVersion) return {};
  const auto work = [&]() -> Result<void> {
    auto made =
        database.execute("create table if not exists imunoise_schema (version bigint not null)");
    if (!made) return made;
    const auto rows = database.query("select version from imunoise_schema");
    if (!rows) return tl::unexpected(rows.error());
    const std::int64_t version = rows->empty() ? 0 : integer(rows->front().front());
    if (version > kSchemaVersion) {
      return fail(fmt::format(
          "the catalogue was made by a later imunoise (its version is {}, this program knows {}): "
          "name another with --catalogue, or use that version",
          version, kSchemaVersion));
    }
    return version == kSchemaVersion ? Result<void>() : make_anew(database);
  };
  return database.transaction(work, "schema");
}

}  // namespace imunoise::catalogue
