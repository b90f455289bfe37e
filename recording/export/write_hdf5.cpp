#include <fmt/core.h>

#include "recording/export/formats.h"
#include "recording/export/output_file.h"
#include "recording/hdf5/attributes.h"
#include "recording/hdf5/dataset.h"

namespace imunoise::recording {
namespace {

bool write_channel(hid_t file, const OutputChannel& channel) {
  const Hdf5Handle dataset = write_dataset(file, channel.name, H5T_IEEE_F64LE, H5T_NATIVE_DOUBLE,
                                           channel.values.data(), channel.values.size());
  return dataset && write_attribute(dataset.get(), "units", channel.unit.symbol);
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
  for (const OutputChannel& channel : channels) good = good && write_channel(file.get(), channel);
  if (!file.close_now() || !good) {
    return fail(
        fmt::format("{}: HDF5 cannot write it; check the folder, its permissions and the space "
                    "left",
                    path.string()));
  }
  return temporary.commit();
}

}  // namespace imunoise::recording
