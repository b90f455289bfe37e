#include "daemon/catalogue/catalogue.h"

#include <fmt/format.h>
#include <unistd.h>

#include <algorithm>
#include <map>
#include <set>
#include <utility>

#include "daemon/catalogue/entry.h"
#include "daemon/catalogue/scan.h"
#include "recording/store/format/layout.h"

namespace imunoise::catalogue {
namespace {

using Key = std::pair<std::string, std::string>;  // bench and folder

v1::CataloguedDevice device_of(const Row& row) {
  v1::CataloguedDevice out;
  out.set_id(text(row[0]));
  out.set_name(text(row[1]));
  out.set_driver(text(row[2]));
  out.set_serial(text(row[3]));
  return out;
}

v1::HistoryPoint point_of(const Row& row) {
  v1::HistoryPoint out;
  out.set_bench(text(row[8]));
  out.set_folder(text(row[9]));
  out.set_started_ns(integer(row[10]));
  out.set_value(real(row[11]));
  if (std::holds_alternative<double>(row[12])) out.set_lower(real(row[12]));
  if (std::holds_alternative<double>(row[13])) out.set_upper(real(row[13]));
  out.set_model(text(row[14]));
  return out;
}

// Columns title, symbol, unit, datasheet_unit, to_datasheet, value, lower_end and upper_end of a
// row, from `at` on.
v1::Coefficient coefficient_of(const Row& row, std::size_t at) {
  v1::Coefficient out;
  out.set_title(text(row[at]));
  out.set_symbol(text(row[at + 1]));
  out.set_unit(text(row[at + 2]));
  out.set_value(real(row[at + 5]));
  if (std::holds_alternative<double>(row[at + 6])) out.set_lower(real(row[at + 6]));
  if (std::holds_alternative<double>(row[at + 7])) out.set_upper(real(row[at + 7]));
  if (text(row[at + 3]).empty()) return out;
  const double to_datasheet = real(row[at + 4]);
  out.set_datasheet_unit(text(row[at + 3]));
  out.set_datasheet_value(out.value() * to_datasheet);
  if (out.has_lower()) out.set_datasheet_lower(out.lower() * to_datasheet);
  if (out.has_upper()) out.set_datasheet_upper(out.upper() * to_datasheet);
  return out;
}

// What it is, or may be where the data do not show it.
double most_of(const v1::Coefficient& one) {
  return one.has_lower() && one.has_upper() && !(one.lower() > 0.0) ? one.upper() : one.value();
}

using LargestNoise = std::map<Key, std::vector<v1::Coefficient>>;

Result<LargestNoise> largest_noise(Database& database) {
  LargestNoise out;
  for (const char* const symbol : {"N", "B", "K"}) {  // in the order in which people know them
    const auto rows = database.query(
        "select bench, folder, title, parameter, unit, datasheet_unit, to_datasheet, value, "
        "lower_end, upper_end from parameters where parameter = :symbol order by bench, folder, "
        "title",
        {std::string(symbol)});
    if (!rows) return tl::unexpected(rows.error());
    for (const Row& row : *rows) {
      std::vector<v1::Coefficient>& all = out[{text(row[0]), text(row[1])}];
      v1::Coefficient one = coefficient_of(row, 2);
      const auto same = std::find_if(all.begin(), all.end(), [&](const v1::Coefficient& other) {
        return other.symbol() == one.symbol() && other.unit() == one.unit();
      });
      if (same == all.end()) {
        all.push_back(std::move(one));
      } else if (most_of(one) > most_of(*same)) {
        *same = std::move(one);
      }
    }
  }
  return out;
}

using ChannelsNoise = std::map<Key, std::vector<v1::ChannelNoise>>;

Result<ChannelsNoise> noise_of_channels(Database& database) {
  const auto rows = database.query(
      "select bench, folder, device, stream, channel, model, title, parameter, unit, "
      "datasheet_unit, to_datasheet, value, lower_end, upper_end from parameters "
      "order by bench, folder, device, stream, channel, term, parameter");
  if (!rows) return tl::unexpected(rows.error());
  ChannelsNoise out;
  const Row* before = nullptr;
  for (const Row& row : *rows) {
    std::vector<v1::ChannelNoise>& all = out[{text(row[0]), text(row[1])}];
    if (before == nullptr || !std::equal(row.begin(), row.begin() + 5, before->begin())) {
      v1::ChannelNoise& one = all.emplace_back();
      one.set_device(text(row[2]));
      one.set_stream(text(row[3]));
      one.set_channel(text(row[4]));
      one.set_model(text(row[5]));
    }
    before = &row;
    *all.back().add_coefficients() = coefficient_of(row, 6);
  }
  return out;
}

}  // namespace

std::string place_in(const std::filesystem::path& root) {
  std::error_code unknown;
  const bool recording = std::filesystem::exists(root / recording::kManifestName, unknown);
  return !recording && ::access(root.c_str(), W_OK) == 0 ? (root / kCatalogueName).string()
                                                         : ":memory:";
}

Result<Catalogue> Catalogue::open(const std::string& where, std::string bench) {
  auto sound = open_sound(where);
  if (!sound) return tl::unexpected(sound.error());
  return Catalogue(std::move(*sound), std::move(bench));
}

// Another program may have read it meanwhile; false: it has.
Result<bool> Catalogue::put(const Found& found, const std::function<void()>& again) {
  bool put = false;
  auto done = database_->transaction(
      [&]() -> Result<void> {
        const auto rows = database_->query(
            "select stamp from recordings where bench = :bench and folder = :folder",
            {bench_, found.folder});
        if (!rows) return tl::unexpected(rows.error());
        put = rows->empty() || text(rows->front().front()) != found.stamp;
        return put ? put_entry(*database_, bench_, found) : Result<void>();
      },
      lock(), again);
  if (!done) return tl::unexpected(done.error());
  return put;
}

Result<Changes> Catalogue::refresh(const recording::FileSystem& files,
                                   const std::filesystem::path& root, const Progress& progress) {
  const auto rows =
      database_->query("select folder, stamp from recordings where bench = :bench", {bench_});
  if (!rows) return tl::unexpected(rows.error());
  std::map<std::string, std::string> known;
  for (const Row& row : *rows) known[text(row[0])] = text(row[1]);
  const auto folders = find_recordings(files, root);
  if (!folders) return tl::unexpected(folders.error());
  Changes out;
  for (std::size_t i = 0; i < folders->size(); ++i) {
    const std::string& folder = (*folders)[i];
    if (progress.stopped()) return fail("stopped");
    const auto report = [&] {
      progress.report(static_cast<double>(i) / static_cast<double>(folders->size()));
    };
    report();
    const auto before = known.extract(folder);
    if (!before.empty() && before.mapped() == stamp_of(files, root / folder)) {
      ++out.unchanged;
      continue;
    }
    const auto put_by_us = put(read_found(files, root, folder), report);
    if (!put_by_us) return tl::unexpected(put_by_us.error());
    ++(*put_by_us ? out.added : out.unchanged);
  }
  for (const auto& one : known) {
    const auto report = [&] { progress.report(1.0); };
    report();
    auto done = database_->transaction([&] { return remove_entry(*database_, bench_, one.first); },
                                       lock(), report);
    if (!done) return tl::unexpected(done.error());
    ++out.removed;
  }
  progress.report(1.0);
  return out;
}

Result<Changes> Catalogue::rebuild(const recording::FileSystem& files,
                                   const std::filesystem::path& root, const Progress& progress) {
  auto done = database_->transaction(
      [&] {
        return database_->execute("update recordings set stamp = '' where bench = :bench",
                                  {bench_});
      },
      lock());
  if (!done) return tl::unexpected(done.error());
  return refresh(files, root, progress);
}

Result<v1::RecordingList> Catalogue::recordings() {
  const auto devices =
      database_->query("select id, name, driver, serial, bench, folder from devices order by name");
  if (!devices) return tl::unexpected(devices.error());
  std::map<Key, std::vector<v1::CataloguedDevice>> of;
  for (const Row& row : *devices) of[{text(row[4]), text(row[5])}].push_back(device_of(row));
  auto noise = largest_noise(*database_);
  if (!noise) return tl::unexpected(noise.error());
  const auto rows = database_->query(
      "select r.bench, r.folder, r.campaign, r.started_ns, r.closed, r.replicates, r.samples, "
      "r.bytes, r.trouble, c.folder from recordings r left join calibrations c "
      "on c.bench = r.bench and c.folder = r.folder order by r.started_ns, r.bench, r.folder");
  if (!rows) return tl::unexpected(rows.error());
  v1::RecordingList out;
  for (const Row& row : *rows) {
    v1::CataloguedRecording& one = *out.add_recordings();
    one.set_bench(text(row[0]));
    one.set_folder(text(row[1]));
    one.set_campaign(text(row[2]));
    one.set_started_ns(integer(row[3]));
    one.set_closed(integer(row[4]) != 0);
    one.set_replicates(static_cast<std::uint32_t>(integer(row[5])));
    one.set_samples(static_cast<std::uint64_t>(integer(row[6])));
    one.set_bytes(static_cast<std::uint64_t>(integer(row[7])));
    one.set_trouble(text(row[8]));
    one.set_calibrated(std::holds_alternative<std::string>(row[9]));
    for (const v1::CataloguedDevice& device : of[{one.bench(), one.folder()}])
      *one.add_devices() = device;
    const auto& largest = (*noise)[{one.bench(), one.folder()}];
    *one.mutable_noise() = {largest.begin(), largest.end()};
  }
  return out;
}

Result<v1::CalibrationList> Catalogue::calibrations() {
  const auto rows = database_->query(
      "select c.bench, c.folder, r.started_ns, c.made_ns, c.model, c.channels, c.fitted, "
      "c.troubled, c.fingerprint, r.fingerprint, c.summary, c.trouble from calibrations c "
      "join recordings r on r.bench = c.bench and r.folder = c.folder "
      "order by r.started_ns, c.bench, c.folder");
  if (!rows) return tl::unexpected(rows.error());
  auto noise = noise_of_channels(*database_);
  if (!noise) return tl::unexpected(noise.error());
  v1::CalibrationList out;
  for (const Row& row : *rows) {
    v1::CataloguedCalibration& one = *out.add_calibrations();
    one.set_bench(text(row[0]));
    one.set_folder(text(row[1]));
    one.set_started_ns(integer(row[2]));
    one.set_made_ns(integer(row[3]));
    one.set_model(text(row[4]));
    one.set_channels(static_cast<std::uint32_t>(integer(row[5])));
    one.set_fitted(static_cast<std::uint32_t>(integer(row[6])));
    one.set_troubled(static_cast<std::uint32_t>(integer(row[7])));
    one.set_summary(text(row[10]));
    one.set_trouble(text(row[11]));
    one.set_outdated(one.trouble().empty() && text(row[8]) != text(row[9]));
    const auto& of = (*noise)[{one.bench(), one.folder()}];
    *one.mutable_noise() = {of.begin(), of.end()};
  }
  return out;
}

Result<Catalogue::AllDevices> Catalogue::all_devices() {
  const auto rows = database_->query(
      "select d.id, d.name, d.driver, d.serial from devices d join recordings r "
      "on r.bench = d.bench and r.folder = d.folder order by r.started_ns, d.name");
  if (!rows) return tl::unexpected(rows.error());
  AllDevices out;
  for (const Row& row : *rows) {
    v1::CataloguedDevice one = device_of(row);
    out.ids[one.serial()].insert(one.id());
    out.ids[one.name()].insert(one.id());
    out.newest[one.id()] = std::move(one);
  }
  return out;
}

Result<std::vector<v1::CataloguedDevice>> Catalogue::devices() {
  auto all = all_devices();
  if (!all) return tl::unexpected(all.error());
  std::vector<v1::CataloguedDevice> out;
  for (auto& [id, one] : all->newest) out.push_back(std::move(one));
  return out;
}

Result<v1::CataloguedDevice> Catalogue::device(const std::string& wanted) {
  auto every = all_devices();
  if (!every) return tl::unexpected(every.error());
  const std::map<std::string, v1::CataloguedDevice>& known = every->newest;
  const std::set<std::string>& meant = every->ids[wanted];
  if (known.contains(wanted)) return known.at(wanted);
  if (meant.size() == 1) return known.at(*meant.begin());
  std::set<std::string> all;
  for (const auto& [id, one] : known) all.insert(id);
  std::string list;
  for (const std::string& id : meant.empty() ? all : meant) list += (list.empty() ? "" : ", ") + id;
  if (!meant.empty())
    return fail(fmt::format("device '{}': ambiguous name; give one of {}", wanted, list));
  return fail(list.empty() ? "there is no device: no recording was found"
                           : fmt::format("device '{}': there is none; there are {}", wanted, list));
}

Result<Parameters> Catalogue::parameters(const std::string& device_id) {
  const auto rows = database_->query(
      "select p.stream, p.channel, p.term, p.parameter, p.title, p.unit, p.datasheet_unit, "
      "p.to_datasheet, p.bench, p.folder, r.started_ns, p.value, p.lower_end, p.upper_end, p.model "
      "from parameters p join recordings r on r.bench = p.bench and r.folder = p.folder "
      "where p.device = :device order by p.stream, p.channel, p.term, p.parameter, r.started_ns, "
      "p.bench, p.folder",
      {device_id});
  if (!rows) return tl::unexpected(rows.error());
  Parameters out;
  const Row* before = nullptr;
  for (const Row& row : *rows) {
    const bool goes_on =
        before != nullptr && std::equal(row.begin(), row.begin() + 4, before->begin());
    v1::ParameterHistory& to = goes_on ? out.back() : out.emplace_back();
    // A copy of a recording is no further calibration.
    const std::int64_t started = integer(row[10]);  // 0: unknown, of what was repaired
    const bool copy = goes_on && started != 0 && started == integer((*before)[10]);
    before = &row;
    if (copy) continue;
    to.set_stream(text(row[0]));
    to.set_channel(text(row[1]));
    to.set_term(text(row[2]));
    to.set_parameter(text(row[3]));
    to.set_title(text(row[4]));
    to.set_unit(text(row[5]));
    to.set_datasheet_unit(text(row[6]));
    to.set_to_datasheet(real(row[7]));
    *to.add_points() = point_of(row);
  }
  return out;
}

}  // namespace imunoise::catalogue
