#include "cli/input.h"

#include "cli/progress_line.h"
#include "recording/store/replicates.h"

namespace imunoise::cli {

Result<std::vector<recording::Replicate>> read_input(const InputArguments& arguments) {
  ProgressLine line("reading");
  if (arguments.files.size() == 1 && std::filesystem::is_directory(arguments.files.front())) {
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
