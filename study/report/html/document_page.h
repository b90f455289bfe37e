#pragma once

#include <cstddef>
#include <string>

#include "study/report/documents/document.h"

namespace imunoise::report {

/// A section as it stands on a page. All text is escaped.
std::string section_markup(const Section& section, std::size_t index);

}  // namespace imunoise::report
