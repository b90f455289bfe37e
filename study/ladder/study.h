#pragma once

// The loop of a study: look at a model, learn what it lacks, add it, watch the error fall, take it
// back.

#include <functional>
#include <optional>

#include "core/support/progress.h"
#include "core/support/result.h"
#include "imunoise/v1/study.pb.h"
#include "recording/import/table/channel.h"
#include "study/cache/cache_folder.h"

namespace imunoise::study {

/// Reads the replicates of a study: a channel, and all that was recorded beside it.
using ReadInput = std::function<Result<std::vector<recording::Replicate>>(
    const v1::StudyInput& input, const std::string& channel)>;

/// Does what a request asks of a study; `study` is empty for an Open. Nothing changes on an error:
/// a file, channel or model that cannot be read, a term that does not fit, nothing to undo or redo,
/// an attempt that does not exist, or the caller stopped it. What was worked out of the recordings
/// is kept where `keep` says; unset: nowhere.
Result<v1::Study> apply(const v1::Study& study, const v1::StudyRequest& request,
                        const ReadInput& read, const Progress& progress = {},
                        const std::optional<CachePlace>& keep = std::nullopt);

/// The current model, in the grammar.
const std::string& current_model(const v1::Study& study);

}  // namespace imunoise::study
