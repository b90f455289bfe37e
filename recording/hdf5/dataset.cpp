#include "recording/hdf5/dataset.h"

#include <fmt/core.h>

#include <algorithm>
#include <utility>

namespace imunoise::recording {
namespace {

// Deflate cannot do better than 1032 to 1, so a dataset that claims more is damaged or was never
// written; without the check a few bytes could ask for all memory.
constexpr std::uint64_t kBestCompression = 1100;

constexpr hsize_t kChunk =
    65536;  // numbers: half a megabyte of doubles, HDF5's chunk cache holds two

// Numbers that lie in other files are not this file's recording (and may be any file of the disk).
bool stored_elsewhere(hid_t dataset) {
  const Hdf5Handle properties(H5Dget_create_plist(dataset), H5Pclose);
  return !properties || H5Pget_layout(properties.get()) == H5D_VIRTUAL ||
         H5Pget_external_count(properties.get()) != 0;
}

}  // namespace

Result<OpenDataset> open_dataset(hid_t group, const std::string& name) {
  const auto trouble = [&](const std::string& what) {
    return fail(fmt::format("dataset {}: {}", name, what));
  };
  OpenDataset out;
  out.id = {H5Dopen2(group, name.c_str(), H5P_DEFAULT), H5Dclose};
  if (!out.id) return trouble("cannot be opened; the file is damaged");
  const Hdf5Handle space(H5Dget_space(out.id.get()), H5Sclose);
  const Hdf5Handle type(H5Dget_type(out.id.get()), H5Tclose);
  if (!space || !type) return trouble("cannot be described; the file is damaged");
  const int rank = H5Sget_simple_extent_ndims(space.get());
  if (rank != 1) {
    return trouble(
        fmt::format("has {} dimensions where one is needed; store each channel as a "
                    "dataset of its own, or choose others with --channel",
                    rank));
  }
  out.type_class = H5Tget_class(type.get());
  out.has_sign = out.type_class == H5T_INTEGER && H5Tget_sign(type.get()) == H5T_SGN_2;
  out.width = H5Tget_size(type.get());
  const hssize_t points = H5Sget_simple_extent_npoints(space.get());
  if (points <= 0 || out.width == 0) return out;
  out.size = static_cast<std::uint64_t>(points);
  if (stored_elsewhere(out.id.get())) {
    return trouble("keeps its numbers in another file; copy them into this one (h5repack)");
  }
  const std::uint64_t stored = H5Dget_storage_size(out.id.get());
  if (out.size / kBestCompression > stored / out.width || stored == 0) {
    return trouble(
        fmt::format("claims {} samples, but only {} bytes are stored; it was not written "
                    "to its end",
                    out.size, stored));
  }
  return out;
}

Hdf5Handle write_dataset(hid_t group, const std::string& name, hid_t stored, hid_t memory,
                         const void* numbers, std::uint64_t size) {
  const hsize_t extent = size;
  const Hdf5Handle space(H5Screate_simple(1, &extent, nullptr), H5Sclose);
  const Hdf5Handle properties(H5Pcreate(H5P_DATASET_CREATE), H5Pclose);
  if (!space || !properties) return {};
  if (size > 0) {  // HDF5 cannot filter what is empty
    const hsize_t chunk = std::min(extent, kChunk);
    if (H5Pset_chunk(properties.get(), 1, &chunk) < 0 || H5Pset_shuffle(properties.get()) < 0 ||
        H5Pset_deflate(properties.get(), 1) < 0 || H5Pset_fletcher32(properties.get()) < 0) {
      return {};
    }
  }
  Hdf5Handle dataset(H5Dcreate2(group, name.c_str(), stored, space.get(), H5P_DEFAULT,
                                properties.get(), H5P_DEFAULT),
                     H5Dclose);
  if (dataset && size > 0 &&
      H5Dwrite(dataset.get(), memory, H5S_ALL, H5S_ALL, H5P_DEFAULT, numbers) < 0) {
    return {};
  }
  return dataset;
}

}  // namespace imunoise::recording
