#pragma once

// The recordings of a study, for every command that computes on one.

#include <filesystem>
#include <string>
#include <vector>

#include "imunoise/v1/study.pb.h"
#include "recording/import/table/channel.h"

namespace imunoise::cli {

/// Error: a file that was moved or deleted since, or cannot be read.
Result<std::vector<recording::Replicate>> read_study_input(
    const v1::StudyInput& input, const std::string& channel,
    const std::vector<std::string>& witnesses);

/// The user's folder for data, as the XDG base directory specification has it; empty where there is
/// none.
std::filesystem::path data_folder();

}  // namespace imunoise::cli
