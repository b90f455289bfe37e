#include "core/effects/couplings/couplings.h"

#include <algorithm>
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

std::vector<Cause> coupling_causes() {
  return {
      {"temperature",
       "coupling to temperature",
       "The bias follows the temperature, possibly with a thermal lag.",
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
       "The bench tilts slowly, and every sensor on it measures this.",
       "the same with a second sensor on another bench",
       {"temperature", "cross_axis"},
       "tilt"},
      {"common_vibration",
       "vibration of the bench",
       "The bench vibrates, and every sensor on it measures this.",
       "the same on a damped plate",
       {"cross_axis", "resonance"},
       "common_vibration"},
      {"cross_axis",
       "coupling to another axis",
       "Another axis leaks in: misalignment, or electronics that the sensors share.",
       "a known motion about the other axis alone",
       {"common_vibration", "supply_voltage"},
       "cross_axis"},
  };
}

bool measures_unknown(const Witness& witness) { return quantity_of(witness) == Quantity::kUnknown; }

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

bool is_motion(std::string_view coupling) {
  return coupling == "g_sensitivity" || coupling == "common_vibration" ||
         coupling == "cross_axis" || coupling == "tilt";
}

bool may_share_motion(Quantity subject, const Witness& witness) {
  return quantity_of(witness) == subject;
}

bool may_leak(const FittedModel& coupled) {
  constexpr double kMost = 0.18;  // the sine of 10°
  const std::size_t effects = coupled.regression.effects().size();
  const Eigen::Index first = coupled.regression.first(effects - 1);
  const Eigen::Index count = coupled.regression.first(effects) - first;
  return coupled.fit.effects.value.segment(first, count).cwiseAbs().maxCoeff() < kMost;
}

bool feels_rocking(Quantity subject, const Witness& witness) {
  return subject == Quantity::kAngularRate && quantity_of(witness) == Quantity::kAcceleration;
}

}  // namespace imunoise
