#include <fmt/core.h>

#include <algorithm>

#include "recording/export/formats.h"
#include "recording/export/output_file.h"
#include "recording/hdf5/attributes.h"

namespace imunoise::recording {
namespace {

constexpr hsize_t kChunk = 65536;  // samples: half a megabyte, HDF5's chunk cache holds two

bool write_dataset(hid_t file, const OutputChannel& channel) {
  const hsize_t size = channel.values.size();
  const hsize_t chunk = std::min(size, kChunk);
  const Hdf5Handle space(H5Screate_simple(1, &size, nullptr), H5Sclose);
  const Hdf5Handle properties(H5Pcreate(H5P_DATASET_CREATE), H5Pclose);
  if (!space || H5Pset_chunk(properties.get(), 1, &chunk) < 0 ||
      H5Pset_shuffle(properties.get()) < 0 || H5Pset_deflate(properties.get(), 1) < 0 ||
      H5Pset_fletcher32(properties.get()) < 0) {
    return false;
  }
  const Hdf5Handle dataset(H5Dcreate2(file, channel.name.c_str(), H5T_IEEE_F64LE, space.get(),
                                      H5P_DEFAULT, properties.get(), H5P_DEFAULT),
                           H5Dclose);
  return dataset &&
         H5Dwrite(dataset.get(), H5T_NATIVE_DOUBLE, H5S_ALL, H5S_ALL, H5P_DEFAULT,
                  channel.values.data()) >= 0 &&
         write_attribute(dataset.get(), "units", channel.unit.symbol);
}

}  // namespace

Result<void> write_hdf5(const std::filesystem::path& path, std::span<const OutputChannel> channels,
                        Hertz rate, const Metadata& metadata) {
  const QuietHdf5 quiet;
  TemporaryName temporary(path);
  Hdf5Handle file(H5Fcreate(temporary.path().c_str(), H5F_ACC_TRUNC, H5P_DEFAULT, H5P_DEFAULT),
                  H5Fclose);
  bool good = file && write_attribute(file.get(), "rate_hz", rate.value);
  for (const auto& [key, value] : metadata) {
    good = good && write_attribute(file.get(), key, value);
  }
  for (const OutputChannel& channel : channels) good = good && write_dataset(file.get(), channel);
  if (!file.close_now() || !good) {
    return fail(
        fmt::format("{}: HDF5 cannot write it; check the folder, its permissions and the space "
                    "left",
                    path.string()));
  }
  return temporary.commit();
}

}  // namespace imunoise::recording
