#include "core/support/units.h"

#include <algorithm>
#include <array>
#include <cctype>
#include <charconv>
#include <cmath>
#include <numbers>
#include <optional>

#include "core/support/utf8.h"

namespace imunoise {
namespace {

constexpr double kDegree = std::numbers::pi / 180.0;  // rad
constexpr double kHour = 3600.0;                      // s
constexpr double kGravity = 9.80665;                  // m/s^2, standard
constexpr double kIcePoint = 273.15;                  // K
constexpr double kRankine = 5.0 / 9.0;                // K, a degree Fahrenheit

struct NamedUnit {
  std::string_view symbol;
  Quantity quantity;
  double to_si;
  double si_offset = 0.0;
};

// The first symbol of each quantity is its SI unit. Spellings are compared after normalise().
constexpr std::array kUnits = {
    NamedUnit{"rad/s", Quantity::kAngularRate, 1.0},
    NamedUnit{"mrad/s", Quantity::kAngularRate, 1e-3},
    NamedUnit{"deg/s", Quantity::kAngularRate, kDegree},
    NamedUnit{"dps", Quantity::kAngularRate, kDegree},
    NamedUnit{"mdeg/s", Quantity::kAngularRate, kDegree * 1e-3},
    NamedUnit{"mdps", Quantity::kAngularRate, kDegree * 1e-3},
    NamedUnit{"deg/h", Quantity::kAngularRate, kDegree / kHour},
    NamedUnit{"m/s^2", Quantity::kAcceleration, 1.0},
    NamedUnit{"cm/s^2", Quantity::kAcceleration, 1e-2},
    NamedUnit{"mm/s^2", Quantity::kAcceleration, 1e-3},
    NamedUnit{"g", Quantity::kAcceleration, kGravity},
    NamedUnit{"mg", Quantity::kAcceleration, kGravity * 1e-3},
    NamedUnit{"ug", Quantity::kAcceleration, kGravity * 1e-6},
    NamedUnit{"T", Quantity::kMagneticFluxDensity, 1.0},
    NamedUnit{"uT", Quantity::kMagneticFluxDensity, 1e-6},
    NamedUnit{"nT", Quantity::kMagneticFluxDensity, 1e-9},
    NamedUnit{"gauss", Quantity::kMagneticFluxDensity, 1e-4},
    NamedUnit{"mgauss", Quantity::kMagneticFluxDensity, 1e-7},
    NamedUnit{"K", Quantity::kTemperature, 1.0},
    NamedUnit{"degC", Quantity::kTemperature, 1.0, kIcePoint},
    NamedUnit{"C", Quantity::kTemperature, 1.0, kIcePoint},
    NamedUnit{"degF", Quantity::kTemperature, kRankine, 459.67 * kRankine},
    NamedUnit{"F", Quantity::kTemperature, kRankine, 459.67 * kRankine},
    NamedUnit{"V", Quantity::kVoltage, 1.0},
    NamedUnit{"mV", Quantity::kVoltage, 1e-3},
    NamedUnit{"1", Quantity::kUnknown, 1.0},
    NamedUnit{"a.u.", Quantity::kUnknown, 1.0},
};

void replace_all(std::string& text, std::string_view from, std::string_view to) {
  for (auto at = text.find(from); at != std::string::npos; at = text.find(from, at + to.size())) {
    text.replace(at, from.size(), to);
  }
}

// One spelling for the many ways people write the same unit: "°/s", "m/s²", "m s-2", "deg/sec".
std::string normalise(std::string_view text) {
  std::string out(text);
  for (const auto& [from, to] : std::initializer_list<std::pair<const char*, const char*>>{
           {" ", ""},           {"(", ""},         {")", ""},           {"⁻", "^-"},
           {"¹", "1"},          {"^-²", "^-2"},    {"º", "deg"},        {"DPS", "dps"},
           {"Deg/", "deg/"},    {"/Sec", "/s"},    {"degree/", "deg/"}, {"/second", "/s"},
           {".s", "s"},         {"°C", "degC"},    {"°", "deg"},        {"µ", "u"},
           {"μ", "u"},          {"²", "^2"},       {"**", "^"},         {"s-2", "/s^2"},
           {"s^-2", "/s^2"},    {"//", "/"},       {"degrees", "deg"},  {"/sec", "/s"},
           {"/hour", "/h"},     {"/hr", "/h"},     {"·", ""},           {"m/s/s", "m/s^2"},
           {"m/s2", "m/s^2"},   {"s-1", "/s"},     {"s^-1", "/s"},      {"celsius", "degC"},
           {"Celsius", "degC"}, {"degree_", "deg"}}) {
    replace_all(out, from, to);
  }
  return out;
}

// For messages: some 40 bytes of a long text, to the end of a character.
std::string beginning(std::string_view text) {
  constexpr std::size_t kShown = 40;
  std::size_t end = 0;
  while (end < std::min(kShown, text.size()))
    end += std::max<std::size_t>(1, utf8_sequence(text.substr(end)));
  return std::string(text.substr(0, end)) + (end < text.size() ? "…" : "");
}

std::optional<Unit> known_unit(std::string_view text) {
  constexpr std::size_t kLongest = 64;  // bytes: longer is no unit
  if (text.size() > kLongest) return std::nullopt;
  const std::string wanted = normalise(text);
  for (const NamedUnit& unit : kUnits) {
    if (unit.symbol == wanted)
      return Unit{std::string(unit.symbol), unit.quantity, unit.to_si, unit.si_offset};
  }
  return std::nullopt;
}

// "0.0076 deg/s", "1/131 deg/s"
std::optional<Unit> parse_multiple(std::string_view text) {
  const char* const end = text.data() + text.size();
  double factor = 0.0;
  auto [at, error] = std::from_chars(text.data(), end, factor);
  if (error != std::errc()) return std::nullopt;
  if (at != end && *at == '/') {
    double divisor = 0.0;
    const auto [stop, wrong] = std::from_chars(at + 1, end, divisor);
    if (wrong != std::errc()) return std::nullopt;
    factor /= divisor;
    at = stop;
  }
  if (at == end || *at != ' ' || !(factor > 0.0) || !std::isfinite(factor)) return std::nullopt;
  auto unit = known_unit(std::string_view(at + 1, static_cast<std::size_t>(end - at - 1)));
  if (!unit || unit->si_offset != 0.0) return std::nullopt;
  unit->to_si *= factor;
  unit->symbol = std::string(text);
  return unit;
}

}  // namespace

Result<Unit> parse_unit(std::string_view text) {
  if (const auto multiple = parse_multiple(text)) return *multiple;
  if (const auto known = known_unit(text)) return *known;
  std::string known;
  for (const NamedUnit& unit : kUnits) {
    known += known.empty() ? "" : ", ";
    known += unit.symbol;
  }
  return fail("unknown unit '" + beginning(text) + "' (known: " + known + ")");
}

std::string_view si_symbol(Quantity quantity) {
  const auto* const found = std::find_if(kUnits.begin(), kUnits.end(), [&](const NamedUnit& unit) {
    return unit.quantity == quantity;
  });
  return found->symbol;
}

CoefficientUnits coefficient_units(Coefficient coefficient, Quantity quantity) {
  const bool gyro = quantity == Quantity::kAngularRate;
  const bool accelerometer = quantity == Quantity::kAcceleration;
  const std::string si =
      gyro ? "rad/s" : std::string(quantity == Quantity::kUnknown ? "unit" : si_symbol(quantity));
  const double micro_g = kGravity * 1e-6;
  const auto pick = [&](std::string_view symbol, std::string_view title, std::string si_unit,
                        std::string gyro_unit, double gyro_factor, std::string acc_unit,
                        double acc_factor) {
    CoefficientUnits out{symbol, title, std::move(si_unit), "", 1.0};
    if (gyro) {
      out.datasheet = std::move(gyro_unit);
      out.to_datasheet = gyro_factor;
    } else if (accelerometer) {
      out.datasheet = std::move(acc_unit);
      out.to_datasheet = acc_factor;
    }
    return out;
  };
  switch (coefficient) {
    case Coefficient::kQuantisation:
      return pick("Q", "quantisation noise",
                  gyro            ? "rad"
                  : accelerometer ? "m/s"
                                  : si + "·s",
                  "arcsec", kHour / kDegree, "µm/s", 1e6);
    case Coefficient::kRandomWalk:
      return pick("N",
                  gyro            ? "angle random walk"
                  : accelerometer ? "velocity random walk"
                                  : "white noise density",
                  si + "/√Hz", "°/√h", 60.0 / kDegree, "µg/√Hz", 1.0 / micro_g);
    case Coefficient::kBiasInstability:
      return pick("B", "bias instability", si, "°/h", kHour / kDegree, "µg", 1.0 / micro_g);
    case Coefficient::kRateRandomWalk:
      return pick("K", gyro ? "rate random walk" : "bias random walk",
                  gyro            ? "rad/s²/√Hz"
                  : accelerometer ? "m/s³/√Hz"
                                  : si + "/s/√Hz",
                  "(°/h)/√h", kHour * 60.0 / kDegree, "µg/√h", 60.0 / micro_g);
    case Coefficient::kRamp:
      return pick("R", gyro ? "rate ramp" : "bias ramp",
                  gyro            ? "rad/s²"
                  : accelerometer ? "m/s³"
                                  : si + "/s",
                  "(°/h)/h", kHour * kHour / kDegree, "µg/h", kHour / micro_g);
    case Coefficient::kAmplitude:
      return pick("σ", "standard deviation", si, "°/h", kHour / kDegree, "µg", 1.0 / micro_g);
    case Coefficient::kCorrelationTime:
      return {"T", "correlation time", "s", "", 1.0};
    case Coefficient::kFrequency:
      return {"f", "frequency", "Hz", "", 1.0};
    case Coefficient::kCutoff:
      return {"f_c", "cut-off frequency", "Hz", "", 1.0};
    case Coefficient::kDampingRatio:
      return {"ζ", "damping ratio", "1", "", 1.0};
  }
  return {};
}

}  // namespace imunoise
