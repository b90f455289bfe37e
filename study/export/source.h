#pragma once

// Fits from the JSON that imunoise itself prints.

#include <optional>
#include <string>
#include <vector>

#include "core/support/result.h"
#include "imunoise/v1/array.pb.h"
#include "imunoise/v1/calibration.pb.h"
#include "imunoise/v1/noise.pb.h"

namespace imunoise::study {

/// The fit of a channel, and whose it is.
struct SourceFit {
  std::string device;  ///< its name in the recording; empty for plain files
  v1::FitReport fit;
};

/// The fits of a calibration; channels without one are left out.
std::vector<SourceFit> fits_of(const v1::Calibration& calibration);

/// What `imunoise calibrate --json` or `imunoise fit --json` printed, or a recording's
/// calibration.json. Error: anything else, or no fit in it.
Result<std::vector<SourceFit>> parse_fits(const std::string& text);

/// What `imunoise array --json` printed; nothing for any other text.
std::optional<v1::ArrayReport> parse_array(const std::string& text);

/// Of one device, and of the channels that one of the patterns matches; empty: all. Error: no such
/// device or channel, or several devices and none named.
Result<std::vector<SourceFit>> chosen_fits(const std::vector<SourceFit>& fits,
                                           const std::string& device,
                                           const std::vector<std::string>& channels);

}  // namespace imunoise::study
