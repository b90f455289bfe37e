#include "recording/import/hdf5_table.h"

#include <fmt/core.h>

#include <algorithm>
#include <cmath>
#include <utility>

#include "recording/hdf5/attributes.h"
#include "recording/import/file.h"
#include "recording/import/hdf5_dataset.h"
#include "recording/import/select.h"
#include "recording/import/time_column.h"

namespace imunoise::recording {
namespace {

// Names of the datasets in the root group, sorted. Links to elsewhere are not followed: an external
// one could name any file of the disk.
std::vector<std::string> dataset_names(hid_t file) {
  std::vector<std::string> names;
  const auto visit = [](hid_t group, const char* name, const H5L_info_t* link,
                        void* out) -> herr_t {
    auto& found = *static_cast<std::vector<std::string>*>(out);
    H5O_info_t object = {};
    if (link->type == H5L_TYPE_HARD && found.size() <= kMaximumColumns &&
        H5Oget_info_by_name2(group, name, &object, H5O_INFO_BASIC, H5P_DEFAULT) >= 0 &&
        object.type == H5O_TYPE_DATASET) {
      found.emplace_back(name);
    }
    return 0;
  };
  H5Literate(file, H5_INDEX_NAME, H5_ITER_NATIVE, nullptr, visit, &names);
  std::sort(names.begin(), names.end());
  return names;
}

// What a dataset of times shows, when there is one.
Result<EvenTimes> times_of_dataset(const std::string& file, hid_t id,
                                   const std::vector<std::string>& names) {
  const auto found = std::find_if(names.begin(), names.end(),
                                  [](const std::string& name) { return is_time_name(name); });
  if (found == names.end()) {
    return fail(
        fmt::format("{}: no root attribute rate_hz and so no sampling rate; give it with "
                    "--rate HZ",
                    file));
  }
  const auto trouble = [&](const Error& error) {
    return fail(fmt::format("{}: {} (--rate HZ ignores the times)", file, error.message));
  };
  const Result<Hdf5Dataset> dataset = Hdf5Dataset::open(id, *found);
  if (!dataset) return trouble(dataset.error());
  const auto units = read_string_attribute(dataset->id(), "units");
  if (!units) return trouble(units.error());
  const auto seconds = time_unit(*found, units->value_or(""));
  if (!seconds) return trouble({fmt::format("dataset {}: {}", *found, seconds.error().message)});
  const Result<Samples> samples = dataset->read();
  if (!samples) return trouble(samples.error());
  const std::vector<double> times = std::visit(
      [](const auto& values) { return std::vector<double>(values.begin(), values.end()); },
      *samples);
  const std::string place = fmt::format("{}: dataset {}", file, *found);
  return even_times(times,
                    {place, *seconds, [](std::size_t i) { return fmt::format("sample {}", i); }});
}

// As it is written. What cannot be read is told once the dataset is wanted.
std::string unit_of_dataset(hid_t file, const std::string& name) {
  const Result<Hdf5Dataset> dataset = Hdf5Dataset::open(file, name);
  if (!dataset) return "";
  const auto text = read_string_attribute(dataset->id(), "units");
  return text ? text->value_or("") : "";
}

Result<Column> read_column(const std::string& file, const Hdf5Dataset& dataset,
                           const std::string& name, const ImportOptions& options) {
  const auto trouble = [&](const std::string& what) {
    return fail(fmt::format("{}: dataset {}: {}", file, name, what));
  };
  const auto scale = read_number_attribute(dataset.id(), "scale_factor");
  if (!scale) return trouble(scale.error().message);
  const auto offset = read_number_attribute(dataset.id(), "add_offset");
  if (!offset) return trouble(offset.error().message);
  const auto text = read_string_attribute(dataset.id(), "units");
  if (!text) return trouble(text.error().message);
  Column column{name, {}, scale->value_or(1.0), offset->value_or(0.0), {}};
  if (!std::isfinite(column.scale) || column.scale == 0.0 || !std::isfinite(column.offset)) {
    return trouble(
        fmt::format("scale_factor {} and add_offset {} must be finite, the factor not 0; "
                    "correct the attributes",
                    column.scale, column.offset));
  }
  Result<Unit> unit = resolve_unit(file, name, text->value_or(""), options);
  if (!unit) return tl::make_unexpected(unit.error());
  column.unit = std::move(*unit);
  Result<Samples> samples = dataset.read();
  if (!samples) return fail(fmt::format("{}: {}", file, samples.error().message));
  column.samples = std::move(*samples);
  return column;
}

}  // namespace

Result<Table> read_hdf5_table(const std::filesystem::path& path, const ImportOptions& options,
                              FileProgress& progress) {
  if (const Result<File> readable = File::open(path); !readable) {
    return tl::make_unexpected(readable.error());
  }
  const QuietHdf5 quiet;
  const std::string name = path.string();
  const Hdf5Handle file(H5Fopen(name.c_str(), H5F_ACC_RDONLY, H5P_DEFAULT), H5Fclose);
  if (!file) {
    return fail(
        fmt::format("{}: HDF5 cannot open it: truncated, damaged or still being written; copy "
                    "it again",
                    name));
  }
  const std::vector<std::string> names = dataset_names(file.get());
  std::vector<Offer> offers;
  for (const std::string& dataset : names)
    offers.push_back({dataset, !is_time_name(dataset), unit_of_dataset(file.get(), dataset)});
  const auto wanted = select_columns(name, offers, options);
  if (!wanted) return tl::make_unexpected(wanted.error());

  Table table;
  const auto stated = read_number_attribute(file.get(), "rate_hz");
  if (options.rate) {
    table.rate = *options.rate;
  } else if (!stated) {
    return fail(
        fmt::format("{}: root {}; give the rate with --rate HZ", name, stated.error().message));
  } else if (*stated) {
    const Result<Hertz> rate = checked_rate(name, "the root attribute rate_hz", **stated);
    if (!rate) return tl::make_unexpected(rate.error());
    table.rate = *rate;
  } else {
    const Result<EvenTimes> times = times_of_dataset(name, file.get(), names);
    if (!times) return tl::make_unexpected(times.error());
    table.rate = times->rate;
    table.jitter = times->jitter;
  }
  for (std::size_t i = 0; i < wanted->size(); ++i) {
    if (progress.stopped()) return fail(fmt::format("{}: the import was stopped", name));
    const std::string& channel = names[(*wanted)[i]];
    const Result<Hdf5Dataset> dataset = Hdf5Dataset::open(file.get(), channel);
    if (!dataset) return fail(fmt::format("{}: {}", name, dataset.error().message));
    Result<Column> column = read_column(name, *dataset, channel, options);
    if (!column) return tl::make_unexpected(column.error());
    table.columns.push_back(std::move(*column));
    progress.report(static_cast<double>(i + 1) / static_cast<double>(wanted->size()));
  }
  return table;
}

}  // namespace imunoise::recording
