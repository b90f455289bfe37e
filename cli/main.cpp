#include <optional>

#include "cli/commands/commands.h"
#include "core/support/memory.h"
#include "core/support/parallel.h"
#include "recording/scratch/large_arrays.h"
#include "study/cache/cache_folder.h"

int main(int argc, char** argv) {
  using namespace imunoise;
  const auto parsed = cli::parse_arguments(argc, argv);
  if (const int* status = std::get_if<int>(&parsed)) return *status;
  const auto& arguments = std::get<cli::Arguments>(parsed);
  const bool lasts = std::holds_alternative<cli::RecordArguments>(arguments.command) ||
                     std::holds_alternative<cli::EmulateArguments>(arguments.command);
  if (!lasts) {
    keep_freed_memory();
    recording::keep_large_arrays({.folder = study::user_cache_folder()});
  }
  std::optional<ThreadLimit> limit;
  if (arguments.threads) limit.emplace(*arguments.threads);
  return std::visit([](const auto& command) { return cli::run(command); }, arguments.command);
}
