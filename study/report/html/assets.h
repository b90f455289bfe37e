#pragma once

// The page's style and script, embedded at build time from assets/.

#include <string_view>

namespace imunoise::report {

extern const std::string_view kPageCss;
extern const std::string_view kPageJs;

}  // namespace imunoise::report
