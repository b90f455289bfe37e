#include "recording/import/hdf5/hdf5_reader.h"

#include <fmt/core.h>

#include <algorithm>
#include <optional>
#include <type_traits>
#include <utility>

#include "recording/hdf5/attributes.h"
#include "recording/import/hdf5/hdf5_dataset.h"
#include "recording/import/table/array_columns.h"
#include "recording/import/table/select.h"
#include "recording/import/table/time_names.h"

namespace imunoise::recording {
namespace {

constexpr int kDeepest = 4;  // groups within groups

struct Found {
  std::vector<std::string> datasets;  // paths
  std::vector<std::string> groups;
};

// What lies in a group. Links to elsewhere are not followed: an external one could name any file of
// the disk. MATLAB keeps what it refers to in "#refs#".
Found found_in(hid_t file, const std::string& group) {
  Found out;
  const auto visit = [](hid_t at, const char* name, const H5L_info_t* link, void* to) -> herr_t {
    auto& found = *static_cast<Found*>(to);
    H5O_info_t object = {};
    if (link->type != H5L_TYPE_HARD || name[0] == '#' ||
        found.datasets.size() + found.groups.size() > kMaximumColumns ||
        H5Oget_info_by_name2(at, name, &object, H5O_INFO_BASIC, H5P_DEFAULT) < 0)
      return 0;
    if (object.type == H5O_TYPE_DATASET) found.datasets.emplace_back(name);
    if (object.type == H5O_TYPE_GROUP) found.groups.emplace_back(name);
    return 0;
  };
  const Hdf5Handle opened(H5Gopen2(file, group.c_str(), H5P_DEFAULT), H5Gclose);
  if (opened) H5Literate(opened.get(), H5_INDEX_NAME, H5_ITER_NATIVE, nullptr, visit, &out);
  const std::string prefix = group == "/" ? "" : group + "/";
  for (std::vector<std::string>* const names : {&out.datasets, &out.groups}) {
    for (std::string& name : *names) name.insert(0, prefix);
    std::sort(names->begin(), names->end());
  }
  return out;
}

// Times and rates are of no use alone.
bool is_channel(const std::string& path) {
  const std::string_view name = last_part(path);
  return !is_time_name(name) && rate_called(name, 1.0) == 0.0;
}

// Paths of the datasets in the root; and of those in groups (structs of MATLAB) where the root has
// no channel.
std::vector<std::string> dataset_paths(hid_t file) {
  std::vector<std::string> out;
  std::vector<std::string> groups = {"/"};
  for (int depth = 0;
       depth < kDeepest && std::none_of(out.begin(), out.end(), is_channel) && !groups.empty();
       ++depth) {
    std::vector<std::string> deeper;
    for (const std::string& group : groups) {
      Found found = found_in(file, group);
      out.insert(out.end(), found.datasets.begin(), found.datasets.end());
      deeper.insert(deeper.end(), found.groups.begin(), found.groups.end());
      if (out.size() > kMaximumColumns || deeper.size() > kMaximumColumns) return out;
    }
    groups = std::move(deeper);
  }
  return out;
}

// "imu/gyro" is imu.gyro, as in MATLAB.
std::string name_of_path(std::string path) {
  std::replace(path.begin(), path.end(), '/', '.');
  return path;
}

struct FoundDataset {
  Hdf5Column about;  // what its columns share
  Shape shape;
  double number = 0.0;  // of a single one
  bool may_be_channels = true;

  bool is_readable() const { return about.trouble.empty(); }
};

FoundDataset describe(hid_t file, const std::string& path, const std::string& member = "") {
  FoundDataset out;
  out.about.name = name_of_path(path) + (member.empty() ? "" : "." + member);
  out.about.dataset = path;
  out.about.member = member;
  const Result<Hdf5Dataset> dataset = Hdf5Dataset::open(file, path, member);
  if (!dataset) {
    const Hdf5Dataset::Form form = Hdf5Dataset::form(file, path);
    out.about.trouble = dataset.error().message;
    out.may_be_channels = form.may_be_channels();
    out.number = form.single.value_or(0.0);
    return out;
  }
  out.shape = dataset->shape();
  out.about.scale = read_number_attribute(dataset->id(), "scale_factor");
  out.about.offset = read_number_attribute(dataset->id(), "add_offset");
  for (const char* const name : {"units", "unit", "Units", "Unit"}) {
    out.about.unit = read_string_attribute(dataset->id(), name);
    if (!out.about.unit || *out.about.unit) break;
  }
  if (!out.shape.is_single()) return out;
  // What cannot be read is told once the dataset is wanted.
  (void)dataset->read(0, false, [&](const Samples& number) {
    std::visit([&](const auto& values) { out.number = static_cast<double>(values[0]); }, number);
    return false;
  });
  return out;
}

void add_columns(const FoundDataset& found, std::uint64_t length, Hdf5Facts& to) {
  const Shape& shape = found.shape;
  const bool across =
      shape.rows != length && (shape.columns == length || shape.columns > shape.rows);
  const std::uint64_t count = across ? shape.rows : shape.columns;
  const std::uint64_t samples = across ? shape.columns : shape.rows;
  if (count > kMaximumColumns) {
    Hdf5Column& one = to.columns.emplace_back(found.about);
    one.trouble = fmt::format("dataset {}: {} x {} numbers are no channels; save fewer columns",
                              one.dataset, shape.rows, shape.columns);
    return;
  }
  const std::vector<std::string> names = column_names(found.about.name, count);
  for (std::uint64_t c = 0; c < count; ++c) {
    Hdf5Column& one = to.columns.emplace_back(found.about);
    one.name = names[c];
    one.place = c;
    one.across = across;
    one.size = samples;
    one.by_default = samples == length;
  }
}

// Columns of all datasets. Beside matrices, what has another length is no channel; beside columns,
// what has no form of one, or too few numbers. A damaged one may have been a channel.
void learn_columns(hid_t file, Hdf5Facts& to) {
  std::vector<FoundDataset> all;
  std::vector<Shape> shapes;
  for (const std::string& path : dataset_paths(file)) {
    const std::vector<std::string> members = Hdf5Dataset::form(file, path).members;
    if (members.empty()) all.push_back(describe(file, path));
    for (const std::string& member : members) all.push_back(describe(file, path, member));
    if (all.size() > kMaximumColumns) break;
  }
  for (const FoundDataset& one : all) {
    if (one.is_readable()) shapes.push_back(one.shape);
  }
  const bool matrices =
      std::any_of(shapes.begin(), shapes.end(), [](const Shape& one) { return one.columns > 1; });
  const std::uint64_t length = common_length(shapes);
  const bool recorded = length >= kMinimumSamples;
  for (const FoundDataset& one : all) {
    if (to.columns.size() > kMaximumColumns) break;
    if (matrices && one.is_readable() && !one.shape.is_single()) {
      add_columns(one, length, to);
      continue;
    }
    Hdf5Column& column = to.columns.emplace_back(one.about);
    column.size = one.shape.rows;
    const bool may_be = one.is_readable() ? one.shape.may_be_recorded() : one.may_be_channels;
    column.by_default = !matrices && (may_be || !recorded);
    const double rate = rate_called(column.name, one.number);
    if (rate > 0.0 && to.rate && !*to.rate) {
      to.rate = std::optional(rate);
      to.rate_from = "its " + column.name;
    }
  }
}

}  // namespace

Result<std::unique_ptr<Hdf5Source>> Hdf5Source::open(const std::filesystem::path& path) {
  const QuietHdf5 quiet;
  auto out = std::make_unique<Hdf5Source>();
  out->file_ = {H5Fopen(path.c_str(), H5F_ACC_RDONLY, H5P_DEFAULT), H5Fclose};
  if (!out->file_) {
    return fail("HDF5 cannot open it: truncated, damaged or still being written; copy it again");
  }
  for (const char* const name : {"rate_hz", "fs", "sample_rate", "sampling_rate"}) {
    out->facts_.rate = read_number_attribute(out->file_.get(), name);
    out->facts_.rate_from = fmt::format("the root attribute {}", name);
    if (!out->facts_.rate || *out->facts_.rate) break;
  }
  learn_columns(out->file_.get(), out->facts_);
  return out;
}

Result<void> Hdf5Source::read(std::size_t column, const std::function<bool(Samples piece)>& take) {
  const QuietHdf5 quiet;
  const Hdf5Column& wanted = facts_.columns.at(column);
  const auto opened = Hdf5Dataset::open(file_.get(), wanted.dataset, wanted.member);
  if (!opened) return tl::make_unexpected(opened.error());
  return opened->read(wanted.place, wanted.across, take);
}

Result<Samples> Hdf5Source::read(std::size_t column) {
  std::optional<Samples> out;
  const auto done = read(column, [&](Samples piece) {
    if (!out) {
      out = std::move(piece);
      return true;
    }
    std::visit(
        [&](auto& values) {
          const auto& more = std::get<std::decay_t<decltype(values)>>(piece);
          values.insert(values.end(), more.begin(), more.end());
        },
        *out);
    return true;
  });
  if (!done) return tl::make_unexpected(done.error());
  return std::move(*out);
}

}  // namespace imunoise::recording
