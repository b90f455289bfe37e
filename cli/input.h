#pragma once

#include <vector>

#include "cli/arguments.h"
#include "study/analysis/series.h"

namespace imunoise::cli {

/// Whether the input is the folder of one recording of imunoise, not files or a bag of ROS 2.
bool is_recording(const InputArguments& arguments);

/// Error: options that are for files, which a recording would ignore.
Result<void> check_for_recording(const recording::ImportOptions& options);

/// The replicates of the user's files; series borrow from them.
Result<std::vector<recording::Replicate>> read_input(const InputArguments& arguments);

/// The files of read_input() once more: what the preflight found in them is not told again.
Result<std::vector<recording::Replicate>> read_again(const InputArguments& arguments);

/// The same as read_input(), as a stream of its own for each sensor of another rate, unless the
/// user names what to read: a camera of two topics gives rates, then accelerations.
Result<std::vector<std::vector<recording::Replicate>>> read_streams(
    const InputArguments& arguments);

/// read_input() with every channel that was recorded beside those that are named; with `witnesses`
/// only those of them.
Result<std::vector<recording::Replicate>> read_with_witnesses(
    InputArguments arguments, const std::vector<std::string>& witnesses);

/// read_input() for what needs samples of one time: channels of several devices of a recording are
/// joined on the host's clock (recording/store/across.h), and how is told on stderr. Error: a
/// device that cannot be joined with the others, too.
Result<std::vector<recording::Replicate>> read_together(const InputArguments& arguments);

/// One series for each channel.
std::vector<study::Series> all_series(const std::vector<recording::Replicate>& replicates);

/// The channels that models are fitted to, a series each; they borrow from the replicates.
struct Subjects {
  std::vector<recording::Replicate> replicates;
  std::vector<study::Series> series;
};

/// The model that the user names, if any.
inline std::vector<std::string> named_model(const std::optional<std::string>& model) {
  return model ? std::vector<std::string>{*model} : std::vector<std::string>();
}

/// read_input(), with the witnesses that the effects of the models follow: these are no subjects
/// unless the user names them. Error: a model that cannot be read, too.
Result<Subjects> read_subjects(const InputArguments& arguments,
                               const std::vector<std::string>& models);

}  // namespace imunoise::cli
