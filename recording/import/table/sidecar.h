#pragma once

// The sidecar `<file>.json`: what the bare numbers in <file> are.

#include <filesystem>
#include <optional>
#include <string>
#include <string_view>

#include "core/support/result.h"
#include "imunoise/v1/sidecar.pb.h"

namespace imunoise::recording {

/// Where the sidecar of `path` lies: "run.f64" has "run.f64.json".
std::filesystem::path sidecar_path(const std::filesystem::path& path);

/// Parses a sidecar's text. `file` is for messages. Error: not JSON, an unknown field, a rate that
/// is not positive, a factor that is 0 or not finite, a channel without a name.
Result<v1::Sidecar> parse_sidecar(std::string_view file, std::string_view json);

/// Reads the sidecar of `path`; nothing when there is none.
Result<std::optional<v1::Sidecar>> read_sidecar(const std::filesystem::path& path);

}  // namespace imunoise::recording
