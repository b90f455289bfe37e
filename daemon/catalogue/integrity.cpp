#include "daemon/catalogue/integrity.h"

#include <fcntl.h>
#include <fmt/format.h>
#include <sys/file.h>
#include <unistd.h>

#include <algorithm>
#include <optional>
#include <string_view>
#include <utility>
#include <vector>

#include "daemon/catalogue/checksums.h"
#include "daemon/catalogue/entry.h"
#include "daemon/catalogue/schema.h"

namespace imunoise::catalogue {
namespace {

namespace fs = std::filesystem;

constexpr std::string_view kNoDatabase = "not a database";

// The tables and indices as they were made.
Result<std::vector<Row>> tables_of(Database& database) {
  return database.query("select type, name, tbl_name, sql from sqlite_master order by name");
}

// Damage of the file as a whole; empty: none. Error: it cannot be looked at.
Result<std::string> structural_damage(Database& database) {
  const auto found = database.query("pragma integrity_check(1)");
  if (!found) return tl::unexpected(found.error());
  const std::string said = found->empty() ? "it returned nothing" : text(found->front().front());
  if (said != "ok") return said.substr(said.rfind('\n') + 1);
  if (auto ready = prepare_schema(database); !ready) return tl::unexpected(ready.error());
  const auto model = Database::open(":memory:");
  if (!model) return tl::unexpected(model.error());
  if (auto ready = prepare_schema(**model); !ready) return tl::unexpected(ready.error());
  const auto wanted = tables_of(**model);
  const auto tables = tables_of(database);
  if (!wanted) return tl::unexpected(wanted.error());
  if (!tables) return tl::unexpected(tables.error());
  const bool whole = std::all_of(wanted->begin(), wanted->end(), [&](const Row& one) {
    return std::find(tables->begin(), tables->end(), one) != tables->end();
  });
  return whole ? "" : "it has other tables than a catalogue";
}

bool says(const Error& error, std::string_view what) {
  return error.message.find(what) != std::string::npos;
}

// What SQLite says of bytes that are no database any more. Anything may have been named by mistake;
// what is called as a catalogue is one.
bool tells_of_damage(const Error& error, const fs::path& file) {
  return says(error, "malformed") || says(error, "unsupported file format") ||
         says(error, "no such column") ||
         (says(error, kNoDatabase) && file.filename() == kCatalogueName);
}

tl::unexpected<Error> with_way_out(const Error& error) {
  return fail(error.message +
              (says(error, kNoDatabase)
                   ? "; name another one with --catalogue, unless this was a catalogue: you can "
                     "delete it, and imunoise rebuilds it from the recordings"
                   : "; you can delete a catalogue: imunoise rebuilds it from the recordings"));
}

Result<SoundDatabase> open_and_check(const std::string& where, std::string& damage) {
  auto database = Database::open(where);
  if (!database) return tl::unexpected(database.error());
  const std::optional<fs::path>& file = (*database)->file();
  if (!file) {
    if (auto ready = prepare_schema(**database); !ready) return with_way_out(ready.error());
    return SoundDatabase{std::move(*database), ""};
  }
  const auto found = structural_damage(**database);
  if (found) {
    damage = *found;
  } else if (tells_of_damage(found.error(), *file)) {
    damage = found.error().message.substr(where.size() + 2);  // "WHERE: "
  } else {
    return with_way_out(found.error());
  }
  return SoundDatabase{std::move(*database), ""};
}

// One program at a time sets a file aside, so that none sets aside what another has just made. What
// is locked is the name that it gets: to close the file itself would end SQLite's own locks on it.
class OneAtATime {
 public:
  explicit OneAtATime(const fs::path& aside)
      : file_(::open(aside.c_str(), O_RDWR | O_CREAT | O_CLOEXEC, 0644)) {
    if (file_ >= 0) ::flock(file_, LOCK_EX);
  }
  ~OneAtATime() {
    if (file_ >= 0) ::close(file_);
  }
  OneAtATime(const OneAtATime&) = delete;
  OneAtATime& operator=(const OneAtATime&) = delete;

 private:
  int file_;
};

Result<SoundDatabase> replace(const std::string& where) {
  const fs::path file = where;
  fs::path aside = file;
  aside += ".damaged";
  const OneAtATime alone(aside);
  std::string damage;
  if (auto again = open_and_check(where, damage); !again || damage.empty()) return again;
  std::error_code trouble;
  for (const char* const journal : {"-journal", "-wal", "-shm"}) {
    fs::remove(file.string() + journal, trouble);  // it would be played into the new file
  }
  fs::rename(file, aside, trouble);
  if (trouble)
    return fail(fmt::format("{}: damaged ({}), and cannot be renamed: {}; delete it", where, damage,
                            trouble.message()));
  const std::string first = std::exchange(damage, "");
  auto out = open_and_check(where, damage);
  if (!out) return out;
  if (!damage.empty()) return fail(fmt::format("{}: {}", where, damage));
  out->repair = fmt::format(
      "{}: damaged ({}); imunoise renamed it to {} and builds a new catalogue from the recordings",
      where, first, aside.filename().string());
  return out;
}

Result<void> forget_damaged_entries(const std::string& where, SoundDatabase& sound) {
  auto found = damaged_entries(*sound.database);
  if (!found) return tl::unexpected(found.error());
  if (found->empty()) return {};
  // Checked again under the lock.
  const auto work = [&]() -> Result<void> {
    found = damaged_entries(*sound.database);
    if (!found) return tl::unexpected(found.error());
    for (const auto& [bench, folder] : *found) {
      if (auto done = remove_entry(*sound.database, bench, folder); !done) return done;
    }
    return {};
  };
  if (auto done = sound.database->transaction(work); !done) return done;
  if (!found->empty() && sound.repair.empty()) {
    sound.repair = fmt::format("{}: {} damaged entries; imunoise reads these recordings again",
                               where, found->size());
  }
  return {};
}

}  // namespace

Result<SoundDatabase> open_sound(const std::string& where) {
  std::string damage;
  auto out = open_and_check(where, damage);
  if (!out || !out->database->file()) return out;
  if (!damage.empty()) {
    out->database.reset();
    out = replace(where);
    if (!out) return out;
  }
  if (auto done = forget_damaged_entries(where, *out); !done) return tl::unexpected(done.error());
  return out;
}

}  // namespace imunoise::catalogue
