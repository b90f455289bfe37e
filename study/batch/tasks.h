#pragma once

// What the tasks of a batch ask for.

#include "core/effects/simulation.h"
#include "imunoise/v1/batch.pb.h"
#include "study/calibration/calibrate.h"

namespace imunoise::study {

/// `now_ns`: when the calibration is made, ns since 1970-01-01 UTC.
CalibrateOptions calibrate_options(const v1::CalibrationSettings& settings, std::int64_t now_ns);

/// The replicates of one set. Error: a model that cannot be read, leaves values open or follows
/// another channel.
Result<Simulation> simulation_of(const v1::SimulationTask& task, std::uint32_t set);

}  // namespace imunoise::study
