#pragma once

#include "core/regression/current.h"
#include "core/search/suggestion.h"

namespace imunoise {

/// White noise behind a Butterworth filter of any order, analog or digital, in place of other fast
/// noise or beside white noise, which then comes behind the filter. With so many forms it resembles
/// other fast noise: it gains nothing unless it explains clearly more than every one of `others`.
/// Resonances of `others` that hardly ring gain nothing where the filter explains as much.
Suggestion search_low_pass(const Current& current, Suggestions& others);

}  // namespace imunoise
