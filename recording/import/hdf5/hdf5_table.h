#pragma once

// HDF5 files whose datasets are channels, or matrices with a column a channel (h5py, xarray, MATLAB
// v7.3, our own export).

#include <filesystem>
#include <string>

#include "recording/import/hdf5/hdf5_reader.h"
#include "recording/import/table/options.h"
#include "recording/import/table/table.h"

namespace imunoise::recording {

/// Reads the wanted channels. Attributes of a dataset: scale_factor, add_offset, units (CF names);
/// of the root: rate_hz. Without rate_hz a dataset named as a time column gives the rate.
/// Errors: see import_files.
Result<Table> read_hdf5_table(const std::filesystem::path& path, const ImportOptions& options,
                              FileProgress& progress);
/// The same of a file that is open; `name` is for messages.
Result<Table> read_hdf5_table(const std::string& name, Hdf5Reader& reader,
                              const ImportOptions& options, FileProgress& progress);

}  // namespace imunoise::recording
