#pragma once

// HDF5 datasets. Everything of ours has one dimension, and is shuffled, deflated, checksummed.

#include <cstdint>
#include <string>

#include "core/support/result.h"
#include "recording/hdf5/handle.h"

namespace imunoise::recording {

/// Deflate cannot do better than 1032 to 1, so a dataset that claims more is damaged or was never
/// written; without the check a few bytes could ask for all memory.
inline constexpr std::uint64_t kBestCompression = 1100;

/// An open dataset that can be read without surprise: its numbers lie in the file itself, and it
/// claims no more of them than the stored bytes can hold.
struct OpenDataset {
  Hdf5Handle id;
  std::uint64_t size = 0;     ///< numbers
  std::uint64_t columns = 1;  ///< extent of the second dimension
  H5T_class_t type_class = H5T_NO_CLASS;
  bool has_sign = false;  ///< For integers.
  std::size_t width = 0;  ///< Bytes a number.
};

/// Opens dataset `name` of a file or group, of one or at most `dimensions` (2) dimensions. Error,
/// without the file's name: what it is instead.
Result<OpenDataset> open_dataset(hid_t group, const std::string& name, int dimensions = 1);

/// Writes `size` numbers, of type `memory` in memory and `stored` in the file; returns the open
/// dataset, for attributes. An invalid handle when HDF5 refuses.
Hdf5Handle write_dataset(hid_t group, const std::string& name, hid_t stored, hid_t memory,
                         const void* numbers, std::uint64_t size);

/// Reads all numbers of a dataset as `memory` has them, into room for as many. False: they are
/// damaged.
bool read_dataset(const OpenDataset& dataset, hid_t memory, void* numbers);

}  // namespace imunoise::recording
