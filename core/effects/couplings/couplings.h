#pragma once

#include <string_view>
#include <vector>

#include "core/effect/subject.h"
#include "core/regression/fitted_model.h"

namespace imunoise {

/// The causes of a coupling to a witness.
std::vector<Cause> coupling_causes();

/// What a coupling to a witness is called: by the witness's quantity, else by its name.
std::string_view coupling_effect(Quantity subject, const Witness& witness);
/// True for a witness of which nothing says what it measures.
bool measures_unknown(const Witness& witness);
/// Couplings to surroundings without a recording; constant ones are excluded.
std::vector<std::string_view> unrecorded_couplings(const Subject& subject);
/// True for the couplings, by their ids, through which motion enters.
bool is_motion(std::string_view coupling);
/// True where both sensors could feel the same motion, so that it need not be the one leaking into
/// the other.
bool may_share_motion(Quantity subject, const Witness& witness);
/// True where the last effect, a coupling to another axis, is small enough to be that axis leaking
/// in: by misalignment, at most as by 10 degrees. What of that axis is its own noise does not leak,
/// so that the part it shares shows at some frequencies only.
bool may_leak(const FittedModel& coupled);
/// True for a gyroscope beside an accelerometer, which sees the bench tilt.
bool feels_rocking(Quantity subject, const Witness& witness);

}  // namespace imunoise
