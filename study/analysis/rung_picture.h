#pragma once

#include <string>
#include <vector>

#include "core/diagnosis/views/left_over.h"
#include "imunoise/v1/diagnosis.pb.h"

namespace imunoise::study {

/// What the figures of a fitted model are drawn from. `left`: left_over() of it; `replicates` are
/// their names, `channel` that of the one under study.
v1::RungPicture picture_of(const FittedModel& trial, const LeftOver& left,
                           const std::string& channel, const std::vector<std::string>& replicates);

}  // namespace imunoise::study
