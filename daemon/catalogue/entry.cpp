#include "daemon/catalogue/entry.h"

#include <fmt/format.h>

#include <cmath>
#include <map>
#include <set>

#include "daemon/catalogue/checksums.h"
#include "recording/store/manifest/manifest.h"

namespace imunoise::catalogue {
namespace {

// insert into TABLE values (:a, :b, ...)
Result<void> insert(Database& database, std::string_view table, const std::vector<Value>& values) {
  std::string places;
  for (std::size_t i = 0; i < values.size(); ++i)
    places += fmt::format("{}:v{}", i == 0 ? "" : ", ", i);
  return database.execute(fmt::format("insert into {} values ({})", table, places), values);
}

Value number(bool known, double value) {
  return known && std::isfinite(value) ? Value(value) : Value();
}

std::int64_t signed_count(std::uint64_t count) { return static_cast<std::int64_t>(count); }

Result<void> put_recording(Database& database, const std::string& bench, const Found& found) {
  const v1::Manifest& manifest = found.manifest;
  std::set<std::string> replicates;
  std::uint64_t samples = 0;
  std::uint64_t bytes = 0;
  for (const v1::ChunkEntry& chunk : manifest.chunks()) {
    replicates.insert(chunk.file().substr(0, chunk.file().find('/')));
    samples += chunk.samples();
    bytes += chunk.bytes();
  }
  return insert(
      database, "recordings",
      {bench, found.folder, found.stamp, manifest.campaign(), manifest.started_ns(),
       std::int64_t{manifest.closed() ? 1 : 0}, recording::fingerprint(manifest),
       signed_count(replicates.size()), signed_count(samples), signed_count(bytes), found.trouble});
}

Result<void> put_devices(Database& database, const std::string& bench, const Found& found) {
  for (const v1::RecordedDevice& device : found.manifest.devices()) {
    auto done = insert(
        database, "devices",
        {bench, found.folder, device.name(), device_id(device), device.driver(), device.serial()});
    if (!done) return done;
  }
  return {};
}

Result<void> put_calibration(Database& database, const std::string& bench, const Found& found) {
  const v1::Calibration& calibration = *found.calibration;
  std::int64_t fitted = 0;
  std::int64_t troubled = 0;
  for (const v1::ChannelCalibration& one : calibration.channels()) {
    fitted += one.has_fit() ? 1 : 0;
    troubled += one.troubles().empty() ? 0 : 1;
  }
  return insert(database, "calibrations",
                {bench, found.folder, calibration.made_ns(),
                 fmt::format("{}", fmt::join(calibration.settings().models(), ", ")),
                 calibration.fingerprint(), std::int64_t{calibration.channels_size()}, fitted,
                 troubled, calibration.summary(), found.calibration_trouble});
}

// "AR1", or "AR1 (2)" where the model has several.
std::vector<std::string> labels(const v1::FitReport& fit) {
  std::map<std::string, int> count;
  for (const v1::Term& term : fit.terms()) ++count[term.name()];
  std::map<std::string, int> seen;
  std::vector<std::string> out;
  for (const v1::Term& term : fit.terms()) {
    const int number = ++seen[term.name()];
    out.push_back(count[term.name()] > 1 ? fmt::format("{} ({})", term.name(), number)
                                         : term.name());
  }
  return out;
}

// A channel by its own name, whatever else was recorded with it: "imu0/imu/gyro_x" is "gyro_x".
std::string own_name(const v1::ChannelCalibration& channel) {
  const std::string prefix = channel.device() + "/" + channel.stream() + "/";
  return channel.channel().starts_with(prefix) ? channel.channel().substr(prefix.size())
                                               : channel.channel();
}

Result<void> put_coefficients(Database& database, const std::string& bench, const Found& found,
                              const std::string& device, const v1::ChannelCalibration& channel) {
  const v1::FitReport& fit = channel.fit();
  const std::vector<std::string> names = labels(fit);
  std::set<std::pair<std::string, std::string>> known;  // a file may say anything twice
  for (int t = 0; t < fit.terms_size(); ++t) {
    const std::string& term = names[static_cast<std::size_t>(t)];
    for (const v1::Coefficient& one : fit.terms(t).coefficients()) {
      if (!std::isfinite(one.value()) || !known.emplace(term, one.symbol()).second) continue;
      // Of a value that may be zero its upper end tells the unit.
      const double si = one.value() > 0.0 ? one.value() : one.upper();
      const double sheet = one.value() > 0.0 ? one.datasheet_value() : one.datasheet_upper();
      const double factor = si > 0.0 && std::isfinite(sheet / si) ? sheet / si : 0.0;
      auto done =
          insert(database, "parameters",
                 {bench, found.folder, device, channel.stream(), own_name(channel), term,
                  one.symbol(), one.title(), one.value(), number(one.has_lower(), one.lower()),
                  number(one.has_upper(), one.upper()), one.unit(), one.datasheet_unit(), factor,
                  fit.model()});
      if (!done) return done;
    }
  }
  return {};
}

Result<void> put_calibration_entry(Database& database, const std::string& bench,
                                   const Found& found) {
  if (!found.calibration && found.calibration_trouble.empty()) return {};
  Found readable = found;
  if (!readable.calibration) readable.calibration.emplace();
  if (auto done = put_calibration(database, bench, readable); !done) return done;
  std::map<std::string, std::string> ids;
  for (const v1::RecordedDevice& device : found.manifest.devices())
    ids[device.name()] = device_id(device);
  std::set<std::pair<std::string, std::string>> seen;  // streams and channels of a device
  for (const v1::ChannelCalibration& channel : readable.calibration->channels()) {
    const auto id = ids.find(channel.device());
    if (id == ids.end() ||
        !seen.emplace(id->second + "/" + channel.stream(), own_name(channel)).second)
      continue;
    auto done = put_coefficients(database, bench, found, id->second, channel);
    if (!done) return done;
  }
  return {};
}

}  // namespace

Result<void> remove_entry(Database& database, const std::string& bench, const std::string& folder) {
  for (const char* const table :
       {"parameters", "calibrations", "devices", "recordings", "checksums"}) {
    auto done = database.execute(
        fmt::format("delete from {} where bench = :bench and folder = :folder", table),
        {bench, folder});
    if (!done) return done;
  }
  return {};
}

Result<void> put_entry(Database& database, const std::string& bench, const Found& found) {
  if (auto done = remove_entry(database, bench, found.folder); !done) return done;
  if (auto done = put_recording(database, bench, found); !done) return done;
  if (auto done = put_devices(database, bench, found); !done) return done;
  if (auto done = put_calibration_entry(database, bench, found); !done) return done;
  return seal_entry(database, bench, found.folder);
}

}  // namespace imunoise::catalogue
