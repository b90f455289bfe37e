#pragma once

// The writers behind write_samples(), which has checked their arguments.

#include "recording/export/write_samples.h"

namespace imunoise::recording {

Result<void> write_hdf5(const std::filesystem::path& path, std::span<const OutputChannel> channels,
                        Hertz rate, const Metadata& metadata);
Result<void> write_csv(const std::filesystem::path& path, std::span<const OutputChannel> channels,
                       Hertz rate, const Metadata& metadata);
Result<void> write_npy(const std::filesystem::path& path, std::span<const OutputChannel> channels,
                       Hertz rate, const Metadata& metadata);

}  // namespace imunoise::recording
