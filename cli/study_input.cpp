#include "cli/study_input.h"

#include <cstdlib>

#include "cli/input.h"
#include "cli/parse/input_options.h"

namespace imunoise::cli {

Result<std::vector<recording::Replicate>> read_study_input(
    const v1::StudyInput& input, const std::string& channel,
    const std::vector<std::string>& witnesses) {
  for (const std::string& file : input.files()) {
    if (!std::filesystem::exists(file))
      return fail(file + ": not found; this study needs it. Restore it, or start a new study");
  }
  RawInput raw = raw_from(input);
  if (!channel.empty()) raw.channels = {channel};
  return read_with_witnesses(input_from(raw), witnesses);
}

std::filesystem::path data_folder() {
  const char* named = std::getenv("XDG_DATA_HOME");
  if (named != nullptr && *named == '/') return std::filesystem::path(named) / "imunoise";
  const char* home = std::getenv("HOME");
  if (home != nullptr && *home == '/')
    return std::filesystem::path(home) / ".local/share" / "imunoise";
  return {};
}

}  // namespace imunoise::cli
