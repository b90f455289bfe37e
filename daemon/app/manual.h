#pragma once

#include <vector>

#include "cli/manual/man_page.h"

namespace imunoise::app {

/// What imunoise-campaign(5) says.
std::vector<manual::FileText> described_files();

}  // namespace imunoise::app
