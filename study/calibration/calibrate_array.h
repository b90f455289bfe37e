#pragma once

#include "recording/import/table/channel.h"
#include "recording/store/reading/places.h"
#include "study/calibration/calibrate.h"

namespace imunoise::study {

/// Those of the channels that measure one quantity, as one array; without the names of device and
/// stream. Reports are missing when the caller stopped it.
std::vector<v1::ArrayCalibration> arrays_of_stream(
    const std::vector<recording::Replicate>& replicates, const std::vector<std::size_t>& channels,
    const CalibrateOptions& options, const Progress& progress);

/// Channels of one name that measure one quantity in several devices, as one array on the host's
/// clock (recording/store/across.h): every device's gyro_x, every device's gyro_y. Nothing where
/// there is one device. What cannot be joined is told in the array's troubles. Memory: the samples
/// of one such array in all replicates, twice. Reports are missing when the caller stopped it.
std::vector<v1::ArrayCalibration> arrays_across(
    const recording::FileSystem& files, const std::filesystem::path& folder,
    const std::vector<recording::ImportedStream>& streams, const CalibrateOptions& options,
    const Progress& progress);

}  // namespace imunoise::study
