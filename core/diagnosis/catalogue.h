#pragma once

#include <string>
#include <string_view>
#include <vector>

#include "core/diagnosis/subject.h"

namespace imunoise {

/// A physical effect that can be missing from a model.
struct EffectInfo {
  std::string_view id;
  std::string_view title;                      ///< "coupling to temperature"
  std::string_view cause;                      ///< the physics, a sentence
  std::string_view record_next;                ///< what to record to be sure
  std::vector<std::string_view> looks_like{};  ///< ids
  std::string_view family;  ///< effects whose difference is a matter of words share one
};

/// All effects, in the order of the documentation.
const std::vector<EffectInfo>& effect_catalogue();
/// Precondition: an id of the catalogue.
const EffectInfo& effect_info(std::string_view id);

/// The same in the words for a witness (or none), of which nobody may know what it measures.
const EffectInfo& effect_info(std::string_view id, const Witness* witness);
/// The same in the words for a defect of the samples.
const EffectInfo& defect_info(std::string_view id);

/// True for noise that only its spectrum tells: whatever couples in would look the same.
bool told_by_spectrum(std::string_view effect);

/// What a coupling to a witness is called: by the witness's quantity, else by its name.
std::string_view coupling_effect(Quantity subject, const Witness& witness);
/// Couplings to surroundings that nobody recorded: what stood still is no suspect.
std::vector<std::string_view> unrecorded_couplings(const Subject& subject);
/// True where both sensors could feel the same motion, so that it need not be the one leaking into
/// the other.
bool may_share_motion(Quantity subject, const Witness& witness);

/// True for a gyroscope beside an accelerometer, which sees the bench tilt.
bool feels_rocking(Quantity subject, const Witness& witness);

}  // namespace imunoise
