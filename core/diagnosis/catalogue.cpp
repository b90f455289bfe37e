#include "core/diagnosis/catalogue.h"

#include <algorithm>
#include <cassert>
#include <cctype>

namespace imunoise {
namespace {

// What a witness measures, guessed from its name where its unit is unknown.
Quantity quantity_of(const Witness& witness) {
  if (witness.quantity != Quantity::kUnknown) return witness.quantity;
  std::string name = witness.name;
  std::transform(name.begin(), name.end(), name.begin(),
                 [](unsigned char c) { return static_cast<char>(std::tolower(c)); });
  const auto contains = [&](std::string_view part) { return name.find(part) != std::string::npos; };
  if (contains("temp")) return Quantity::kTemperature;
  if (contains("supply") || contains("volt") || contains("vdd") || contains("vcc"))
    return Quantity::kVoltage;
  if (contains("mag")) return Quantity::kMagneticFluxDensity;
  if (contains("acc")) return Quantity::kAcceleration;
  if (contains("gyr") || contains("rate")) return Quantity::kAngularRate;
  return Quantity::kUnknown;
}

}  // namespace

const std::vector<EffectInfo>& effect_catalogue() {
  static const std::vector<EffectInfo> all{
      {"quantisation",
       "quantisation of an accumulated angle or velocity",
       "The converter rounds the integral of the signal; differences of rounding errors fall off "
       "as "
       "1/τ².",
       "the same at a finer resolution, or a few minutes with slow motion that exercises many "
       "codes",
       {"white_noise", "line"},
       "quantisation"},
      {"white_noise",
       "white noise",
       "Thermal noise of the sensing element and its electronics.",
       "a minute at the highest rate the device has",
       {"outliers", "quantisation"},
       "white_noise"},
      {"random_walk",
       "random walk",
       "The bias moves by independent increments, as charge traps and creep let it.",
       "longer, with the temperature beside it",
       {"gauss_markov", "temperature", "step", "flicker"},
       "random_walk"},
      {"gauss_markov",
       "first-order Markov noise",
       "A fluctuation that forgets itself after its correlation time: bias instability.",
       "ten times its correlation time, with the temperature beside it",
       {"flicker", "telegraph", "temperature", "low_pass"},
       "gauss_markov"},
      {"flicker",
       "flicker noise",
       "1/f noise of the electronics: many traps of many time constants.",
       "longer: one Markov process and flicker noise differ only over several decades",
       {"gauss_markov", "random_walk"},
       "flicker"},
      {"rate_ramp",
       "ramp",
       "The bias drifts at a constant rate: ageing, or a temperature that rises steadily.",
       "longer, with the temperature beside it",
       {"warm_up", "temperature", "random_walk", "step"},
       "rate_ramp"},
      {"warm_up",
       "warm-up",
       "The device heats itself after power-on, and its bias settles with that time constant.",
       "two more power-ons from cold: the time constant must come back",
       {"rate_ramp", "temperature", "step"},
       "warm_up"},
      {"low_pass",
       "sensor bandwidth",
       "A filter on the chip takes away the fastest noise; the spectrum rolls off.",
       "the same with the filter set differently",
       {"gauss_markov", "quantisation"},
       "low_pass"},
      {"resonance",
       "resonance",
       "The sensing element, its mount or the bench rings when noise excites it.",
       "the same on another mount, and with a tap on the bench",
       {"line", "gauss_markov"},
       "resonance"},
      {"line",
       "sine wave",
       "A fan, a pump or a building vibrates at one frequency.",
       "the same with fans and pumps off, one after the other",
       {"resonance", "harmonics", "mains_alias"},
       "line"},
      {"harmonics",
       "sine wave and its multiples",
       "A rotating machine shakes the bench at its speed and at multiples of it.",
       "the same with machines off, one after the other",
       {"line", "mains_alias"},
       "line"},
      {"mains_alias",
       "folded mains frequency",
       "The mains, or a multiple, is folded below half the sampling rate.",
       "the same at another sampling rate: the line moves; and on a battery: it goes",
       {"line"},
       "line"},
      {"temperature",
       "coupling to temperature",
       "The bias follows the temperature, perhaps behind the time the heat needs.",
       "a cycle of the temperature up and down by a few kelvin",
       {"random_walk", "supply_voltage", "warm_up", "rate_ramp"},
       "temperature"},
      {"supply_voltage",
       "coupling to the supply voltage",
       "The bias follows the supply, which the reference does not suppress completely.",
       "the same on a battery, then with the supply stepped by 1 %",
       {"temperature", "magnetic"},
       "supply_voltage"},
      {"magnetic",
       "coupling to the magnetic field",
       "Coils or ferromagnetic parts let the field act on the sensor.",
       "the same turned by 90°, or with a magnet moved nearby",
       {"supply_voltage", "temperature"},
       "magnetic"},
      {"g_sensitivity",
       "sensitivity to acceleration",
       "Acceleration bends the sensing element and looks like rotation.",
       "the sensor in six attitudes",
       {"tilt", "common_vibration"},
       "g_sensitivity"},
      {"tilt",
       "slow motion of the bench",
       "The bench tilts slowly, and every sensor on it sees it.",
       "the same with a second sensor on another bench",
       {"temperature", "cross_axis"},
       "tilt"},
      {"common_vibration",
       "vibration of the bench",
       "The bench vibrates, and every sensor on it sees it.",
       "the same on a damped plate",
       {"cross_axis", "resonance"},
       "common_vibration"},
      {"cross_axis",
       "coupling to another axis",
       "Another axis leaks in: misalignment, or electronics that the sensors share.",
       "a known motion about the other axis alone",
       {"common_vibration", "supply_voltage"},
       "cross_axis"},
      {"telegraph",
       "random telegraph noise",
       "A charge trap fills and empties: the bias jumps between two levels.",
       "longer than a hundred jumps, at constant temperature",
       {"gauss_markov", "step"},
       "telegraph"},
      {"step",
       "step",
       "Stress is released, a connector moves, or someone touched the bench.",
       "nothing: cut the recording there, or keep the step in the model",
       {"random_walk", "telegraph", "rate_ramp"},
       "step"},
      {"outliers",
       "outliers",
       "Single samples are disturbed: interference, or errors of the transfer.",
       "the raw words with their checksums",
       {"white_noise", "modulated_variance"},
       "outliers"},
      {"replicate_change",
       "noise that differs between replicates",
       "The device, its surroundings or its settings were not the same in every replicate.",
       "more replicates, with everything that could differ written down",
       {"modulated_variance"},
       "replicate_change"},
      {"modulated_variance",
       "noise that follows another channel",
       "The noise grows with temperature, supply or motion.",
       "plateaus of that channel, each held for an hour",
       {"outliers", "replicate_change"},
       "modulated_variance"},
      {"lost_samples",
       "lost samples",
       "The transfer dropped samples.",
       "the device's counter beside the samples",
       {},
       "integrity"},
      {"duplicated_samples",
       "duplicated samples",
       "The host read faster than the device renewed its registers.",
       "the device's counter or data-ready line",
       {},
       "integrity"},
      {"clock_jitter",
       "clock jitter",
       "Samples are not evenly spaced.",
       "the device's own time stamps",
       {},
       "integrity"},
      {"saturation",
       "saturation",
       "The signal left the range of the converter.",
       "the same with a wider range",
       {},
       "integrity"},
      {"stuck",
       "stuck output",
       "The output stood still while the noise should have moved it.",
       "the device's status word",
       {},
       "integrity"},
  };
  return all;
}

const EffectInfo& effect_info(std::string_view id) {
  const auto& all = effect_catalogue();
  const auto found =
      std::find_if(all.begin(), all.end(), [&](const EffectInfo& one) { return one.id == id; });
  assert(found != all.end());
  return *found;
}

const EffectInfo& effect_info(std::string_view id, const Witness* witness) {
  static const EffectInfo anything{
      "cross_axis",
      "coupling to another channel",
      "What that channel shows, or something that moves with it, enters the output.",
      "the same while that channel is moved on purpose",
      {},
      "cross_axis"};
  const bool unknown = witness != nullptr && quantity_of(*witness) == Quantity::kUnknown;
  return unknown && id == anything.id ? anything : effect_info(id);
}

const EffectInfo& defect_info(std::string_view id) {
  static const EffectInfo codes{
      "quantisation",
      "few codes",
      "The noise is smaller than the step of the converter: rounding is then no white noise, and "
      "depends on where between two codes the mean lies.",
      "the same at a finer resolution or a smaller range",
      {},
      "quantisation"};
  return id == codes.id ? codes : effect_info(id);
}

bool told_by_spectrum(std::string_view effect) {
  return effect == "gauss_markov" || effect == "flicker" || effect == "resonance";
}

std::string_view coupling_effect(Quantity subject, const Witness& witness) {
  switch (quantity_of(witness)) {
    case Quantity::kTemperature:
      return "temperature";
    case Quantity::kVoltage:
      return "supply_voltage";
    case Quantity::kMagneticFluxDensity:
      return "magnetic";
    case Quantity::kAcceleration:
      return subject == Quantity::kAcceleration ? "cross_axis" : "g_sensitivity";
    case Quantity::kAngularRate:
    case Quantity::kUnknown:
      break;
  }
  return "cross_axis";
}

std::vector<std::string_view> unrecorded_couplings(const Subject& subject) {
  std::vector<std::string_view> out{
      "temperature", "supply_voltage", "magnetic",
      subject.quantity == Quantity::kAcceleration ? "cross_axis" : "g_sensitivity",
      "common_vibration"};
  for (const auto* const recorded : {&subject.witnesses, &subject.still}) {
    for (const Witness& one : *recorded) {
      std::erase(out, coupling_effect(subject.quantity, one));
      if (may_share_motion(subject.quantity, one)) std::erase(out, "common_vibration");
    }
  }
  return out;
}

bool may_share_motion(Quantity subject, const Witness& witness) {
  return quantity_of(witness) == subject;
}

bool feels_rocking(Quantity subject, const Witness& witness) {
  return subject == Quantity::kAngularRate && quantity_of(witness) == Quantity::kAcceleration;
}

}  // namespace imunoise
