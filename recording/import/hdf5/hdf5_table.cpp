#include "recording/import/hdf5/hdf5_table.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <utility>

#include "recording/import/hdf5/hdf5_process.h"
#include "recording/import/table/array_columns.h"
#include "recording/import/table/file.h"
#include "recording/import/table/format.h"
#include "recording/import/table/select.h"
#include "recording/import/table/time_names.h"

namespace imunoise::recording {
namespace {

constexpr std::string_view kHdf5Magic = "\x89HDF\r\n\x1a\n";
constexpr std::array kHdf5Extensions = {".h5", ".hdf5", ".hdf", ".nc", ".mat"};

// HDF5 allows a block of the user's before its own magic, at 512 bytes or a doubling of that.
Result<bool> is_hdf5(const File& file) {
  for (std::uint64_t at = 0; at < file.size(); at = at == 0 ? 512 : 2 * at) {
    std::array<char, 8> magic = {};
    const Result<std::size_t> got = file.read_at(at, magic);
    if (!got) return tl::make_unexpected(got.error());
    if (std::string_view(magic.data(), *got) == kHdf5Magic) return true;
  }
  return false;
}

Result<bool> claims_hdf5(const UnknownFile& file) {
  const Result<bool> found = is_hdf5(file.content);
  if (!found || *found) return found;
  if (std::none_of(kHdf5Extensions.begin(), kHdf5Extensions.end(),
                   [&](const char* known) { return file.extension == known; })) {
    return false;
  }
  if (file.head.starts_with("CDF"))
    return fail(
        fmt::format("{}: is a NetCDF file of version 3; convert it with nccopy -k netCDF-4 IN OUT",
                    file.content.name()));
  return fail(
      fmt::format("{}: is not an HDF5 file, despite its name (MATLAB files of version 4 must be "
                  "saved anew); it may be truncated: copy it again",
                  file.content.name()));
}

bool is_time(const Hdf5Column& one) { return is_time_name(last_part(one.name)); }

// The dataset of times, when there is one.
Result<std::optional<TimeColumn>> time_of(const std::string& file, Hdf5Reader& reader) {
  const std::vector<Hdf5Column>& columns = reader.facts().columns;
  const auto found = std::find_if(columns.begin(), columns.end(), is_time);
  if (found == columns.end()) return std::optional<TimeColumn>();
  const auto trouble = [&](const std::string& what) {
    return fail(fmt::format("{}: {} (--rate HZ ignores the times)", file, what));
  };
  if (!found->trouble.empty()) return trouble(found->trouble);
  if (!found->unit) return trouble(found->unit.error().message);
  const Result<Samples> samples = reader.read(static_cast<std::size_t>(found - columns.begin()));
  if (!samples) return trouble(samples.error().message);
  return std::optional(TimeColumn{
      found->name, found->unit->value_or(""),
      std::visit(
          [](const auto& values) { return std::vector<double>(values.begin(), values.end()); },
          *samples)});
}

// As it is written. What cannot be read is told once the dataset is wanted.
std::string written_unit(const Hdf5Column& dataset) {
  return dataset.trouble.empty() && dataset.unit ? dataset.unit->value_or("") : "";
}

Result<Column> read_column(const std::string& file, Hdf5Reader& reader, std::size_t index) {
  const Hdf5Column& dataset = reader.facts().columns[index];
  if (!dataset.trouble.empty()) return fail(fmt::format("{}: {}", file, dataset.trouble));
  const auto trouble = [&](const std::string& what) {
    return fail(fmt::format("{}: dataset {}: {}", file, dataset.name, what));
  };
  if (!dataset.scale) return trouble(dataset.scale.error().message);
  if (!dataset.offset) return trouble(dataset.offset.error().message);
  if (!dataset.unit) return trouble(dataset.unit.error().message);
  Column column{dataset.name,
                {},
                dataset.scale->value_or(1.0),
                dataset.offset->value_or(0.0),
                dataset.unit->value_or("")};
  if (!std::isfinite(column.scale) || column.scale == 0.0 || !std::isfinite(column.offset)) {
    return trouble(
        fmt::format("scale_factor {} and add_offset {} must be finite, the factor not 0; "
                    "correct the attributes",
                    column.scale, column.offset));
  }
  Result<Samples> samples = reader.read(index);
  if (!samples) return fail(fmt::format("{}: {}", file, samples.error().message));
  column.samples = std::move(*samples);
  return column;
}

// Names what a file has beside channels, times and rates.
std::string left_out(const std::vector<Hdf5Column>& columns) {
  constexpr std::size_t kMostNames = 8;
  std::vector<std::string> names;
  for (const Hdf5Column& one : columns) {
    if (!one.by_default && !is_time(one) && !(rate_called(one.name, 1.0) > 0.0))
      names.push_back(one.name);
  }
  if (names.empty()) return "";
  const std::size_t more = names.size() - std::min(names.size(), kMostNames);
  names.resize(names.size() - more);
  return fmt::format("{}{}: not the form or length of a channel: left out", fmt::join(names, ", "),
                     more > 0 ? fmt::format(" and {} more", more) : "");
}

}  // namespace

Result<Table> read_hdf5_table(const std::string& name, Hdf5Reader& reader,
                              const ImportOptions& options, FileProgress& progress) {
  const Hdf5Facts& facts = reader.facts();
  std::vector<Offer> offers;
  for (const Hdf5Column& one : facts.columns)
    offers.push_back({one.name, one.by_default && !is_time(one), written_unit(one)});
  const auto wanted = select_columns(name, offers, options);
  if (!wanted) return tl::make_unexpected(wanted.error());

  Table table;
  if (!options.rate && !facts.rate) {
    return fail(
        fmt::format("{}: root {}; give the rate with --rate HZ", name, facts.rate.error().message));
  }
  if (!options.rate && *facts.rate) {
    table.rate = {**facts.rate, facts.rate_from};
  } else if (!options.rate) {
    Result<std::optional<TimeColumn>> time = time_of(name, reader);
    if (!time) return tl::make_unexpected(time.error());
    table.time = std::move(*time);
  }
  if (std::string left = left_out(facts.columns); !left.empty() && options.channels.empty())
    table.notes.push_back(std::move(left));
  table.row = [](std::size_t i) { return fmt::format("sample {}", i); };
  for (std::size_t i = 0; i < wanted->size(); ++i) {
    if (progress.stopped()) return fail(fmt::format("{}: the import was stopped", name));
    Result<Column> column = read_column(name, reader, (*wanted)[i]);
    if (!column) return tl::make_unexpected(column.error());
    table.columns.push_back(std::move(*column));
    progress.report(static_cast<double>(i + 1) / static_cast<double>(wanted->size()));
  }
  return table;
}

Result<Table> read_hdf5_table(const std::filesystem::path& path, const ImportOptions& options,
                              FileProgress& progress) {
  const Result<File> file = File::open(path);
  if (!file) return tl::make_unexpected(file.error());
  const auto reader = open_hdf5_apart(path, file->size(), [&] { return progress.stopped(); });
  if (!reader) return fail(fmt::format("{}: {}", file->name(), reader.error().message));
  return read_hdf5_table(file->name(), **reader, options, progress);
}

namespace formats {

const ImportFormat& hdf5() {
  static constexpr ImportFormat kFormat = {
      .kind = "HDF5 (.h5)",
      .begins = [](std::string_view head) { return head.starts_with(kHdf5Magic); },
      .claims = claims_hdf5,
      .read = read_hdf5_table};
  return kFormat;
}

}  // namespace formats

}  // namespace imunoise::recording
