#pragma once

// Whether a recording holds what its manifest promises.

#include <string>
#include <vector>

#include "recording/store/manifest/manifest.h"

namespace imunoise::recording {

/// What was set aside, what is missing, and, stream by stream, how many rows; each with the way
/// out. Repaired is what `imunoise verify --repair` put on record.
/// `report` has the streams that were found; `there` the devices' folders, `broken` the paths of
/// files that were set aside, as the manifest writes them.
std::vector<v1::Defect> broken_promises(const v1::Manifest& manifest,
                                        const v1::VerifyReport& report,
                                        const std::vector<DeviceFolder>& there,
                                        const std::vector<std::string>& broken);

}  // namespace imunoise::recording
