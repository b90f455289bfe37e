#pragma once

// Writes samples to files that import_files (and h5py, pandas, NumPy) read back bit for bit.

#include <filesystem>
#include <map>
#include <span>
#include <string>

#include "core/support/result.h"
#include "core/support/units.h"

namespace imunoise::recording {

/// One channel to write. Borrows the values.
struct OutputChannel {
  std::string name;
  std::span<const double> values;  ///< In `unit`, as they are to stand in the file. Finite.
  Unit unit;                       ///< Only its symbol is written.
};

/// What else the file should say: sensor, model, seed, ...
using Metadata = std::map<std::string, std::string>;

/// Writes channels of one length, sampled at `rate`. The extension chooses the format:
///   .h5, .hdf5  one float64 dataset a channel (shuffle, deflate 1, Fletcher-32), attributes
///   `units`;
///               root attributes rate_hz and the metadata;
///   .csv        comments with rate and metadata, a header `name [unit]`, the shortest decimals
///   that
///               give back the same double;
///   .npy        float64 of shape (samples, channels), and the sidecar <path>.json.
/// The file appears under its name when it is complete; an older one of that name is replaced.
///
/// Errors: an extension that is none of these, no channel or no sample, channels of different
/// length, a name that is empty, used twice or holds control characters, metadata called rate_hz, a
/// value that is not finite, a disk that refuses. Thread-safe for different paths.
Result<void> write_samples(const std::filesystem::path& path,
                           std::span<const OutputChannel> channels, Hertz rate,
                           const Metadata& metadata = {});

}  // namespace imunoise::recording
