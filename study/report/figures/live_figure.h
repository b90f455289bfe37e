#pragma once

#include <optional>

#include "imunoise/v1/live.pb.h"
#include "study/figure/figure.h"

namespace imunoise::report {

/// The Allan deviation of a channel that is being recorded, with its 95 % intervals; averaging
/// times that are not known within a factor of two yet are grey. Nothing before two are there.
std::optional<figure::Figure> live_figure(const v1::LiveChannel& channel);

}  // namespace imunoise::report
