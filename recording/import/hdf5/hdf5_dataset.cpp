#include "recording/import/hdf5/hdf5_dataset.h"

#include <fmt/core.h>

#include <algorithm>
#include <array>
#include <limits>

#include "recording/hdf5/attributes.h"
#include "recording/hdf5/dataset.h"

namespace imunoise::recording {

Result<Hdf5Dataset> Hdf5Dataset::open(hid_t file, const std::string& name) {
  Result<OpenDataset> opened = open_dataset(file, name, 2);
  if (!opened) return tl::make_unexpected(opened.error());
  if (opened->type_class != H5T_INTEGER && opened->type_class != H5T_FLOAT) {
    return fail(
        fmt::format("dataset {}: holds no numbers (integers or floats); convert it, or choose "
                    "others with --channel",
                    name));
  }
  if (opened->size == 0 || opened->columns == 0)
    return fail(fmt::format("dataset {}: holds no samples", name));
  const bool counts = opened->type_class == H5T_INTEGER && opened->has_sign;
  const Kind kind = counts && opened->width == 2   ? Kind::kInt16
                    : counts && opened->width == 4 ? Kind::kInt32
                                                   : Kind::kOther;
  return Hdf5Dataset(name, std::move(opened->id), {opened->size / opened->columns, opened->columns},
                     kind);
}

template <class Number>
Result<Samples> Hdf5Dataset::read_as(hid_t memory_type, std::uint64_t column, bool across) const {
  const hsize_t count = across ? shape_.columns : shape_.rows;
  std::vector<Number> values(count);
  const Hdf5Handle space(H5Dget_space(id()), H5Sclose);
  const Hdf5Handle room(H5Screate_simple(1, &count, nullptr), H5Sclose);
  const bool plane = space && H5Sget_simple_extent_ndims(space.get()) == 2;
  const std::array<hsize_t, 2> begin = {across ? column : 0, across ? 0 : column};
  const std::array<hsize_t, 2> extent = {across ? 1 : count, across ? count : 1};
  if (!space || !room ||
      (plane && H5Sselect_hyperslab(space.get(), H5S_SELECT_SET, begin.data(), nullptr,
                                    extent.data(), nullptr) < 0) ||
      H5Dread(id(), memory_type, room.get(), space.get(), H5P_DEFAULT, values.data()) < 0) {
    return fail(
        fmt::format("dataset {}: cannot be read: a chunk is damaged, or needs a filter that "
                    "is not installed; copy the file again or h5repack it",
                    name_));
  }
  const Result<std::optional<double>> fill = read_number_attribute(id(), "_FillValue");
  if (!fill) return fail(fmt::format("dataset {}: {}", name_, fill.error().message));
  if (!*fill) return Samples(std::move(values));
  const auto missing = [&](Number value) { return static_cast<double>(value) == **fill; };
  if (std::none_of(values.begin(), values.end(), missing)) return Samples(std::move(values));
  std::vector<double> out(values.begin(), values.end());
  for (double& value : out) {
    if (value == **fill) value = std::numeric_limits<double>::quiet_NaN();
  }
  return Samples(std::move(out));
}

Result<Samples> Hdf5Dataset::read(std::uint64_t column, bool across) const {
  switch (kind_) {
    case Kind::kInt16:
      return read_as<std::int16_t>(H5T_NATIVE_INT16, column, across);
    case Kind::kInt32:
      return read_as<std::int32_t>(H5T_NATIVE_INT32, column, across);
    case Kind::kOther:
      break;
  }
  return read_as<double>(H5T_NATIVE_DOUBLE, column, across);
}

}  // namespace imunoise::recording
