#pragma once

#include <vector>

#include "cli/arguments.h"
#include "study/analysis/series.h"

namespace imunoise::cli {

/// The replicates of the user's files; series borrow from them.
Result<std::vector<recording::Replicate>> read_input(const InputArguments& arguments);

/// The same with every channel that was recorded beside those that are named.
Result<std::vector<recording::Replicate>> read_with_witnesses(InputArguments arguments);

/// One series for each channel.
std::vector<study::Series> all_series(const std::vector<recording::Replicate>& replicates);

}  // namespace imunoise::cli
