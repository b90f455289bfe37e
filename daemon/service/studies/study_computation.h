#pragma once

// What a job computes, wherever it does so.

#include <functional>

#include "core/support/progress.h"
#include "core/support/result.h"
#include "imunoise/v1/job.pb.h"

namespace imunoise::service {

/// Does what an order asks, on the caller's thread or beside it. Error: as study::apply(), or what
/// became of the process that computed it.
using ComputeStudy =
    std::function<Result<v1::Study>(const v1::JobOrder& order, const Progress& progress)>;

/// In this process. Recordings are read through confined_files() of the order's folders.
/// Thread-safe.
Result<v1::Study> compute_here(const v1::JobOrder& order, const Progress& progress);

}  // namespace imunoise::service
