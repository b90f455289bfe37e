#include <optional>

#include "cli/commands/commands.h"
#include "core/support/memory.h"
#include "core/support/parallel.h"

int main(int argc, char** argv) {
  using namespace imunoise;
  const auto parsed = cli::parse_arguments(argc, argv);
  if (const int* status = std::get_if<int>(&parsed)) return *status;
  const auto& arguments = std::get<cli::Arguments>(parsed);
  const bool lasts = std::holds_alternative<cli::RecordArguments>(arguments.command) ||
                     std::holds_alternative<cli::EmulateArguments>(arguments.command);
  if (!lasts) keep_freed_memory();
  std::optional<ThreadLimit> limit;
  if (arguments.threads) limit.emplace(*arguments.threads);
  return std::visit([](const auto& command) { return cli::run(command); }, arguments.command);
}
