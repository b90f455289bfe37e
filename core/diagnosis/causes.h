#pragma once

#include <string_view>
#include <vector>

#include "core/effect/subject.h"

namespace imunoise {

/// Every physical cause of what a model can miss: of noise, of each effect, and defects of the
/// samples.
const std::vector<Cause>& known_causes();
/// Precondition: an id of a known cause.
const Cause& cause_info(std::string_view id);

/// The same in the words for a witness (or none) that may measure something unknown.
const Cause& cause_info(std::string_view id, const Witness* witness);
/// The same in the words for a defect of the samples.
const Cause& defect_info(std::string_view id);

}  // namespace imunoise
