#include "cli/input.h"

#include "cli/progress_line.h"
#include "recording/store/replicates.h"

namespace imunoise::cli {

namespace {

bool is_recording(const InputArguments& arguments) {
  return arguments.files.size() == 1 && std::filesystem::is_directory(arguments.files.front());
}

}  // namespace

Result<std::vector<recording::Replicate>> read_with_witnesses(InputArguments arguments) {
  // Other files have one clock: all their channels are read.
  if (!is_recording(arguments)) arguments.import.channels.clear();
  arguments.import.beside = true;
  return read_input(arguments);
}

Result<std::vector<recording::Replicate>> read_input(const InputArguments& arguments) {
  ProgressLine line("reading");
  if (is_recording(arguments)) {
    return recording::import_recording(recording::posix_file_system(), arguments.files.front(),
                                       arguments.import, line.progress());
  }
  return recording::import_files(arguments.files, arguments.import, line.progress());
}

std::vector<study::Series> all_series(const std::vector<recording::Replicate>& replicates) {
  std::vector<study::Series> out;
  for (std::size_t i = 0; i < replicates.front().channels.size(); ++i) {
    out.push_back(study::series_of(replicates, i));
  }
  return out;
}

}  // namespace imunoise::cli
