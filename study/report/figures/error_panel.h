#pragma once

#include <optional>
#include <string>

#include "imunoise/v1/diagnosis.pb.h"
#include "study/figure/figure.h"

namespace imunoise::report {

/// "averaging times" of averaging_times.
std::string view_title(const v1::ErrorView& view);

/// The errors of a rung over what chance leaves, a bar a view; those of the rung before as outlines
/// where there is one. A view in dB counts as a ratio of amplitudes. Nothing for a rung of an old
/// file, which has no views.
std::optional<figure::Figure> error_panel(const v1::Rung* before, const v1::Rung& now);

}  // namespace imunoise::report
