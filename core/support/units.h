#pragma once

// The one home of unit conversion. Inside the library everything is SI; people read datasheet
// units.

#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "core/support/result.h"

namespace imunoise {

/// Sampling rate in hertz. A class of its own because 819.2 Hz has no integer period in
/// nanoseconds.
struct Hertz {
  double value = 1.0;
  friend bool operator==(Hertz, Hertz) = default;
};

/// The physical quantity a channel measures.
enum class Quantity {
  kUnknown,  ///< No unit is stated; numbers are taken as they are.
  kAngularRate,
  kAcceleration,
  kMagneticFluxDensity,
  kTemperature,
  kVoltage,
};

/// What an inertial sensor measures.
constexpr bool of_inertia(Quantity quantity) {
  return quantity == Quantity::kAngularRate || quantity == Quantity::kAcceleration;
}

/// A unit of measurement: value in SI = value · to_si + si_offset.
struct Unit {
  std::string symbol;  ///< As people write it, e.g. "deg/s".
  Quantity quantity = Quantity::kUnknown;
  double to_si = 1.0;
  double si_offset = 0.0;  ///< SI; 273.15 K for degC, else 0. Invisible to the wavelet variance.
};

/// The unit that `text` names ("deg/s", "°/h", "mg", "m/s^2", ...), also as a multiple of one, as
/// counts have it ("0.0076 deg/s"). Error: unknown unit, with the known ones listed.
Result<Unit> parse_unit(std::string_view text);

/// Symbol of the SI unit of a quantity, e.g. "rad/s"; "1" when the quantity is unknown.
std::string_view si_symbol(Quantity quantity);

/// What people know a noise by: the coefficients of IEEE Std 952 / 1554, and the amplitude, time
/// and frequency of correlated noises.
enum class Coefficient {
  kQuantisation,     ///< Q, unit·s
  kRandomWalk,       ///< N, unit/√Hz (angle or velocity random walk)
  kBiasInstability,  ///< B, unit
  kRateRandomWalk,   ///< K, unit/s/√Hz
  kRamp,             ///< R, unit/s
  kAmplitude,        ///< A standard deviation, unit
  kCorrelationTime,  ///< s
  kFrequency,        ///< Hz
  kCutoff,           ///< Hz
  kDampingRatio,     ///< dimensionless
};

/// How people write a coefficient: symbol, SI unit, and the unit of datasheets with its factor.
struct CoefficientUnits {
  std::string_view symbol;    ///< "N", "K", ...
  std::string_view title;     ///< "angle random walk", ...
  std::string si;             ///< "rad/s/√Hz"
  std::string datasheet;      ///< "°/√h"; empty when no customary unit exists
  double to_datasheet = 1.0;  ///< value in datasheet unit = SI value · to_datasheet
};

/// Units of a coefficient of a channel that measures `quantity`.
CoefficientUnits coefficient_units(Coefficient coefficient, Quantity quantity);

}  // namespace imunoise
