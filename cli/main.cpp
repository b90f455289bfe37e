#include <algorithm>
#include <cstdlib>
#include <optional>

#include "cli/commands/commands.h"
#include "core/support/memory.h"
#include "core/support/parallel.h"
#include "recording/scratch/large_arrays.h"
#include "study/cache/cache_folder.h"

namespace {

// Large arrays beyond what the user allows lie in a file. Without a word of the user, an export has
// less memory than an analysis: it looks at each channel once.
imunoise::recording::LargeArrays large_arrays(bool exports) {
  imunoise::recording::LargeArrays out{.folder = imunoise::study::user_cache_folder()};
  constexpr std::size_t kExport = std::size_t{64} << 20U;
  if (exports) out.in_memory = out.mapped = kExport;
  const char* const mebibytes =
      std::getenv("IMUNOISE_MEMORY_MIB");  // NOLINT(concurrency-mt-unsafe)
  const long given = mebibytes == nullptr ? 0 : std::strtol(mebibytes, nullptr, 10);
  if (given <= 0) return out;
  out.in_memory = static_cast<std::size_t>(given) << 20U;
  out.mapped = std::min(imunoise::recording::LargeArrays().mapped, out.in_memory);
  return out;
}

}  // namespace

int main(int argc, char** argv) {
  using namespace imunoise;
  const auto parsed = cli::parse_arguments(argc, argv);
  if (const int* status = std::get_if<int>(&parsed)) return *status;
  const auto& arguments = std::get<cli::Arguments>(parsed);
  const bool lasts = std::holds_alternative<cli::RecordArguments>(arguments.command) ||
                     std::holds_alternative<cli::EmulateArguments>(arguments.command);
  if (!lasts) {
    keep_freed_memory();
    recording::keep_large_arrays(
        large_arrays(std::holds_alternative<cli::ExportArguments>(arguments.command)));
  }
  std::optional<ThreadLimit> limit;
  if (arguments.threads) limit.emplace(*arguments.threads);
  return std::visit([](const auto& command) { return cli::run(command); }, arguments.command);
}
