#pragma once

#include <string>

#include "core/support/result.h"

namespace imunoise::drivers {

/// The text of a DBC file, for parse_dbc(). Error: it cannot be read.
Result<std::string> read_dbc_text(const std::string& path);

}  // namespace imunoise::drivers
