#include "recording/import/hdf5/hdf5_dataset.h"

#include <fmt/core.h>

#include <algorithm>
#include <limits>

#include "recording/hdf5/attributes.h"
#include "recording/hdf5/dataset.h"

namespace imunoise::recording {
Result<Hdf5Dataset> Hdf5Dataset::open(hid_t file, const std::string& name) {
  Result<OpenDataset> opened = open_dataset(file, name);
  if (!opened) return tl::make_unexpected(opened.error());
  const std::size_t width = opened->width;
  const bool integer = opened->type_class == H5T_INTEGER && opened->has_sign;
  if (!(integer || opened->type_class == H5T_FLOAT) ||
      !(width == 4 || width == (integer ? 2U : 8U))) {
    return fail(
        fmt::format("dataset {}: is not of type int16, int32, float32 or float64; convert it, or "
                    "choose others with --channel",
                    name));
  }
  if (opened->size == 0) return fail(fmt::format("dataset {}: holds no samples", name));
  const Kind kind = !integer ? Kind::kFloat : width == 2 ? Kind::kInt16 : Kind::kInt32;
  return Hdf5Dataset(name, std::move(opened->id), opened->size, kind);
}

template <class Number>
Result<Samples> Hdf5Dataset::read_as(hid_t memory_type) const {
  std::vector<Number> values(size_);
  if (H5Dread(id(), memory_type, H5S_ALL, H5S_ALL, H5P_DEFAULT, values.data()) < 0) {
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

Result<Samples> Hdf5Dataset::read() const {
  switch (kind_) {
    case Kind::kInt16:
      return read_as<std::int16_t>(H5T_NATIVE_INT16);
    case Kind::kInt32:
      return read_as<std::int32_t>(H5T_NATIVE_INT32);
    case Kind::kFloat:
      break;
  }
  return read_as<double>(H5T_NATIVE_DOUBLE);
}

}  // namespace imunoise::recording
