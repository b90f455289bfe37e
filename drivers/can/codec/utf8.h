#pragma once

#include <string>
#include <string_view>

namespace imunoise::drivers {

/// `text` as it is when it is UTF-8, else read as Latin-1, which most DBC files are written in
/// ("°").
std::string utf8_text(std::string_view text);

}  // namespace imunoise::drivers
