#pragma once

#include <optional>
#include <string>

#include "imunoise/v1/diagnosis.pb.h"
#include "study/figure/figure.h"

namespace imunoise::report {

/// "averaging times" of averaging_times.
std::string view_title(const v1::ErrorView& view);

/// The errors of a report's last rung over what chance leaves, a bar a view; those of the first as
/// outlines where there are two. A view in dB counts as a ratio of amplitudes. Nothing for rungs of
/// an old file, which have no views, or without a ladder.
std::optional<figure::Figure> error_panel(const v1::DiagnosisReport& report);

}  // namespace imunoise::report
