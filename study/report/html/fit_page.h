#pragma once

#include <string>

#include "imunoise/v1/noise.pb.h"

namespace imunoise::report {

/// One self-contained page: no network, works from a file; light, dark, phone and paper. Everything
/// that came from a user or a file is escaped. Without channels the page says so. Thread-safe.
std::string html_page(const v1::FitReports& reports);
std::string html_page(const v1::FitReport& report);

}  // namespace imunoise::report
