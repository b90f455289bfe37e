#include "daemon/config/problem.h"

#include <fmt/core.h>

namespace imunoise::config {

std::string describe(const std::string& file, const Problem& problem) {
  return fmt::format("{}:{}:{}: {}{}{}", file, problem.place.line, problem.place.column,
                     problem.key, problem.key.empty() ? "" : ": ", problem.message);
}

}  // namespace imunoise::config
