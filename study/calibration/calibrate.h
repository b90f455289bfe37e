#pragma once

#include <cstdint>
#include <filesystem>
#include <optional>
#include <string>
#include <vector>

#include "core/inference/near_stationarity.h"
#include "core/support/progress.h"
#include "core/support/result.h"
#include "imunoise/v1/calibration.pb.h"
#include "recording/import/table/channel.h"
#include "recording/store/disk/file_system.h"

namespace imunoise::study {

struct CalibrateOptions {
  /// In the grammar, for the channels. One: it is fitted. Several: of just these, the one that
  /// predicts unseen replicates best. None: chosen among the sub-models of kDefaultModel.
  std::vector<std::string> models;
  std::optional<std::string> array_model;  ///< unset: kDefaultArrayModel
  /// As import_recording() calls them; empty: all angular rates and accelerations.
  std::vector<std::string> channels;
  bool explain = true;         ///< what the choice of the model rests on, and what it lacks
  bool diagnose = true;        ///< which effect the model lacks
  bool array = false;          ///< channels of one quantity in a stream as an array, too
  BootstrapOptions bootstrap;  ///< of the test between replicates
  std::int64_t made_ns = 0;    ///< now: ns since 1970-01-01 UTC
};

/// Error: a model that cannot be read, or that a calibration cannot use.
Result<void> check_models(const CalibrateOptions& options);

/// What the replicates of a recording say about the noise of its channels: wavelet variance, model,
/// fit, near-stationarity, and where asked diagnosis and array. What cannot be done for a channel
/// is told in its troubles and stops neither the other steps nor the other channels. Memory: the
/// samples of one stream in all replicates. Error: not a recording, a channel that it has not,
/// nothing to calibrate, a model that cannot be read, or the caller stopped it.
Result<v1::Calibration> calibrate(const recording::FileSystem& files,
                                  const std::filesystem::path& folder,
                                  const CalibrateOptions& options, const Progress& progress = {});

/// Names of the channels that are called angular rates or accelerations and have no known unit.
std::vector<std::string> axes_without_unit(
    const std::vector<std::vector<recording::Replicate>>& streams);

/// The same for replicates of plain files, one stream after the other: all angular rates and
/// accelerations, or options.channels; axes_without_unit() have a trouble each. Error: none of
/// them, a model that cannot be read, or the caller stopped it.
Result<v1::Calibration> calibrate_files(
    const std::vector<std::vector<recording::Replicate>>& streams, const CalibrateOptions& options,
    const Progress& progress = {});

}  // namespace imunoise::study
