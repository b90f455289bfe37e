#pragma once

#include "recording/import/table/channel.h"
#include "study/calibration/calibrate.h"

namespace imunoise::study {

/// Notes that a step could not be done, unless the step before failed for the very same reason.
void add_trouble(std::string_view step, const Error& error,
                 google::protobuf::RepeatedPtrField<v1::CalibrationTrouble>& to);

/// Everything about channel number `channel` of the replicates but its names. Its report is
/// incomplete when the caller stopped it.
v1::ChannelCalibration calibrate_channel(const std::vector<recording::Replicate>& replicates,
                                         std::size_t channel, const CalibrateOptions& options,
                                         const Progress& progress);

}  // namespace imunoise::study
