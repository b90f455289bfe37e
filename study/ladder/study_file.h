#pragma once

// A study in its file (JSON).

#include <filesystem>
#include <string>

#include "core/support/result.h"
#include "imunoise/v1/study.pb.h"

namespace imunoise::study {

/// Error: what is wrong with the text.
Result<v1::Study> parse_study(const std::string& text);
/// Error: the file cannot be read, or what is wrong with it.
Result<v1::Study> read_study(const std::filesystem::path& file);
std::string study_text(const v1::Study& study);

}  // namespace imunoise::study
