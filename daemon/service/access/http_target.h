#pragma once

// What a request is about: the path and the query of its target.

#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "core/support/result.h"

namespace imunoise::service {

struct Target {
  std::vector<std::string> segments;                       ///< Decoded; none for "/".
  std::vector<std::pair<std::string, std::string>> query;  ///< Decoded, in order.
};

/// "/v1/recordings/array?level=0.01", in origin form, at most 4096 bytes. Error: what is wrong.
/// Nothing that could lead a path elsewhere is let through: a segment is never empty, "." or "..",
/// and holds neither '/' nor '\'; names and values are UTF-8 without control characters.
Result<Target> parse_target(std::string_view target);

}  // namespace imunoise::service
