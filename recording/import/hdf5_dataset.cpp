#include "recording/import/hdf5_dataset.h"

#include <fmt/core.h>

#include <cmath>
#include <type_traits>

#include "recording/hdf5/attributes.h"

namespace imunoise::recording {
namespace {

// Deflate cannot do better than 1032 to 1, so a dataset that claims more is damaged or was never
// written; without the check a few bytes could ask for all memory.
constexpr std::uint64_t kBestCompression = 1100;

// Numbers that lie in other files are not this file's recording (and may be any file of the disk).
bool stored_elsewhere(hid_t dataset) {
  const Hdf5Handle properties(H5Dget_create_plist(dataset), H5Pclose);
  return !properties || H5Pget_layout(properties.get()) == H5D_VIRTUAL ||
         H5Pget_external_count(properties.get()) != 0;
}

}  // namespace

Result<Hdf5Dataset> Hdf5Dataset::open(hid_t file, const std::string& name) {
  const auto trouble = [&](const std::string& what) {
    return fail(fmt::format("dataset {}: {}", name, what));
  };
  Hdf5Handle dataset(H5Dopen2(file, name.c_str(), H5P_DEFAULT), H5Dclose);
  if (!dataset) return trouble("cannot be opened; the file is damaged");
  const Hdf5Handle space(H5Dget_space(dataset.get()), H5Sclose);
  const Hdf5Handle type(H5Dget_type(dataset.get()), H5Tclose);
  if (!space || !type) return trouble("cannot be described; the file is damaged");
  const int rank = H5Sget_simple_extent_ndims(space.get());
  if (rank != 1) {
    return trouble(
        fmt::format("has {} dimensions where one is needed; store each channel as a "
                    "dataset of its own, or choose others with --channel",
                    rank));
  }
  const H5T_class_t type_class = H5Tget_class(type.get());
  const std::size_t width = H5Tget_size(type.get());
  const bool integer = type_class == H5T_INTEGER && H5Tget_sign(type.get()) == H5T_SGN_2;
  if (!(integer || type_class == H5T_FLOAT) || !(width == 4 || width == (integer ? 2U : 8U))) {
    return trouble(
        "is not of type int16, int32, float32 or float64; convert it, or choose others "
        "with --channel");
  }
  const hssize_t points = H5Sget_simple_extent_npoints(space.get());
  if (points <= 0) return trouble("holds no samples");
  const auto count = static_cast<std::uint64_t>(points);
  if (stored_elsewhere(dataset.get())) {
    return trouble("keeps its numbers in another file; copy them into this one (h5repack)");
  }
  const std::uint64_t stored = H5Dget_storage_size(dataset.get());
  if (count / kBestCompression > stored / width || stored == 0) {
    return trouble(
        fmt::format("claims {} samples, but only {} bytes are stored; it was not written "
                    "to its end",
                    count, stored));
  }
  const Kind kind = !integer ? Kind::kFloat : width == 2 ? Kind::kInt16 : Kind::kInt32;
  return Hdf5Dataset(name, std::move(dataset), count, kind);
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
  for (std::size_t i = 0; i < size_; ++i) {
    const auto value = static_cast<double>(values[i]);
    if (std::is_floating_point_v<Number> && !std::isfinite(value)) {
      return fail(
          fmt::format("dataset {}: sample {} is not finite; split the recording there", name_, i));
    }
    if (*fill && value == **fill) {
      return fail(
          fmt::format("dataset {}: sample {} is missing (it equals _FillValue); split the "
                      "recording there",
                      name_, i));
    }
  }
  return Samples(std::move(values));
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
