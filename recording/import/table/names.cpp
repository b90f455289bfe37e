#include "recording/import/table/names.h"

#include <fmt/core.h>

#include <algorithm>
#include <array>
#include <cctype>
#include <vector>

#include "recording/import/table/words.h"

namespace imunoise::recording {
namespace {

struct Stem {
  std::string_view text;
  Quantity quantity;
  bool whole = false;  // the name has nothing before it
  bool increment = false;
  std::string_view unit = {};
};

// The end of a name without its axis. The first that fits counts.
constexpr std::array kStems = {
    Stem{"deltaangle", Quantity::kAngularRate, false, true},
    Stem{"deltatheta", Quantity::kAngularRate, false, true},
    Stem{"dtheta", Quantity::kAngularRate, false, true},
    Stem{"deltavelocity", Quantity::kAcceleration, false, true},
    Stem{"deltavel", Quantity::kAcceleration, false, true},
    Stem{"deltav", Quantity::kAcceleration, false, true},
    Stem{"dv", Quantity::kAcceleration, true, true},
    Stem{"dvel", Quantity::kAcceleration, false, true},
    Stem{"dang", Quantity::kAngularRate, false, true},
    Stem{"angularvelocity", Quantity::kAngularRate, false, false, "rad/s"},
    Stem{"linearacceleration", Quantity::kAcceleration, false, false, "m/s^2"},
    Stem{"gyrorad", Quantity::kAngularRate, false, false, "rad/s"},
    Stem{"gyroadc", Quantity::kAngularRate},
    Stem{"accsmooth", Quantity::kAcceleration},
    Stem{"accelerometerms2", Quantity::kAcceleration, false, false, "m/s^2"},
    Stem{"angularrate", Quantity::kAngularRate},
    Stem{"rotationrate", Quantity::kAngularRate},
    Stem{"turnrate", Quantity::kAngularRate},
    Stem{"angvel", Quantity::kAngularRate},
    Stem{"gyroscope", Quantity::kAngularRate},
    Stem{"gyros", Quantity::kAngularRate},
    Stem{"gyro", Quantity::kAngularRate},
    Stem{"gyr", Quantity::kAngularRate},
    Stem{"omega", Quantity::kAngularRate},
    Stem{"wrss", Quantity::kAngularRate, true},
    Stem{"w", Quantity::kAngularRate, true},
    Stem{"g", Quantity::kAngularRate, true},
    Stem{"specificforce", Quantity::kAcceleration},
    Stem{"acceleration", Quantity::kAcceleration},
    Stem{"accelerometer", Quantity::kAcceleration},
    Stem{"accel", Quantity::kAcceleration},
    Stem{"acc", Quantity::kAcceleration},
    Stem{"arss", Quantity::kAcceleration, true},
    Stem{"a", Quantity::kAcceleration, true},
    Stem{"f", Quantity::kAcceleration, true},
    Stem{"magneticfield", Quantity::kMagneticFluxDensity},
    Stem{"magnetometer", Quantity::kMagneticFluxDensity},
    Stem{"mag", Quantity::kMagneticFluxDensity},
    Stem{"m", Quantity::kMagneticFluxDensity, true},
    Stem{"temperature", Quantity::kTemperature},
    Stem{"temp", Quantity::kTemperature}};

// They say how a number was made, not what it is.
constexpr std::array<std::string_view, 11> kAttributes = {
    "raw",  "imu",      "lsb",  "cal", "uncalibrated", "calibrated",
    "filt", "filtered", "body", "lp",  "lpf"};

constexpr std::array<std::string_view, 17> kCounterNames = {
    "packetcounter", "packetcount", "packet",      "counter",   "count",        "cnt",
    "seq",           "sequence",    "headerseq",   "index",     "idx",          "fieldheaderseq",
    "samplenumber",  "samplecount", "framenumber", "rownumber", "samplecounter"};

template <class Names>
bool is_one_of(const Names& names, std::string_view text) {
  return std::find(names.begin(), names.end(), text) != names.end();
}

const Stem* stem_of(std::string_view text) {
  const auto* const found = std::find_if(kStems.begin(), kStems.end(), [&](const Stem& stem) {
    return stem.whole ? text == stem.text : text.ends_with(stem.text);
  });
  return found == kStems.end() ? nullptr : found;
}

// Units that stand behind an axis, or a sensor: "gyro_x_rad_s", "acc_z_g", "gyro_rad_s",
// "gx_dps".
struct UnitWords {
  std::string_view first;
  std::string_view second;
  Quantity quantity;
  std::string_view unit;
};
constexpr std::array kUnitWords = {UnitWords{"rad", "s", Quantity::kAngularRate, "rad/s"},
                                   UnitWords{"rads", "", Quantity::kAngularRate, "rad/s"},
                                   UnitWords{"radps", "", Quantity::kAngularRate, "rad/s"},
                                   UnitWords{"deg", "s", Quantity::kAngularRate, "deg/s"},
                                   UnitWords{"degs", "", Quantity::kAngularRate, "deg/s"},
                                   UnitWords{"degps", "", Quantity::kAngularRate, "deg/s"},
                                   UnitWords{"dps", "", Quantity::kAngularRate, "deg/s"},
                                   UnitWords{"mdps", "", Quantity::kAngularRate, "mdps"},
                                   UnitWords{"deg", "h", Quantity::kAngularRate, "deg/h"},
                                   UnitWords{"deg", "hr", Quantity::kAngularRate, "deg/h"},
                                   UnitWords{"dph", "", Quantity::kAngularRate, "deg/h"},
                                   UnitWords{"degph", "", Quantity::kAngularRate, "deg/h"},
                                   UnitWords{"m", "s2", Quantity::kAcceleration, "m/s^2"},
                                   UnitWords{"ms2", "", Quantity::kAcceleration, "m/s^2"},
                                   UnitWords{"mps2", "", Quantity::kAcceleration, "m/s^2"},
                                   UnitWords{"mss", "", Quantity::kAcceleration, "m/s^2"},
                                   UnitWords{"mg", "", Quantity::kAcceleration, "mg"},
                                   UnitWords{"g", "", Quantity::kAcceleration, "g"}};

bool is_axis(char c) { return (c >= 'x' && c <= 'z') || (c >= '0' && c <= '3'); }

// "gx", "accy": a sensor and its axis in one word.
bool is_axis_of(std::string_view word, Quantity quantity) {
  if (word.size() < 2 || !is_axis(word.back())) return false;
  const Stem* const sensor = stem_of(word.substr(0, word.size() - 1));
  return sensor != nullptr && sensor->quantity == quantity;
}

// "imu0", "mpu2": a device, not what it measures.
bool is_device(std::string_view word) {
  constexpr std::array<std::string_view, 8> kDevices = {"imu", "sensor", "mpu",  "icm",
                                                        "bmi", "lsm",    "unit", "node"};
  return is_one_of(kDevices, word.substr(0, word.find_last_not_of("0123456789") + 1));
}

// One way to write the words of a unit: "rad_per_sec" is rad, s; the axis before it.
void order_unit(std::vector<std::string>& words) {
  std::erase(words, "per");
  for (std::string& word : words) word = word == "sec" ? "s" : word;
  const bool digit = words.size() > 2 && words.back().size() == 1 && is_axis(words.back().front());
  if (!digit) return;
  for (const UnitWords& one : kUnitWords) {
    const std::size_t count = one.second.empty() ? 1 : 2;
    if (words.size() < count + 2 ||
        words[words.size() - 2] != (count == 2 ? one.second : one.first))
      continue;
    if (count == 2 && words[words.size() - 3] != one.first) continue;
    std::rotate(words.end() - static_cast<std::ptrdiff_t>(count) - 1, words.end() - 1, words.end());
    return;
  }
}

// Takes the words of a unit off the end of a name that has an axis, or a sensor of that kind,
// before them.
const UnitWords* take_unit(std::vector<std::string>& words) {
  for (const UnitWords& one : kUnitWords) {
    const std::size_t count = one.second.empty() ? 1 : 2;
    if (words.size() < count + 1 || words.back() != (count == 2 ? one.second : one.first)) continue;
    if (count == 2 && words[words.size() - 2] != one.first) continue;
    const std::string& before = words[words.size() - count - 1];
    const Stem* const sensor = stem_of(before);
    const bool axis = before.size() == 1 && is_axis(before.front());
    if (axis && words.size() < count + 2) continue;
    if (!axis && !is_axis_of(before, one.quantity) &&
        (sensor == nullptr || sensor->whole || sensor->quantity != one.quantity))
      continue;
    words.resize(words.size() - count);
    return &one;
  }
  return nullptr;
}

bool glob(std::string_view pattern, std::string_view text) {
  std::size_t p = 0;
  std::size_t t = 0;
  std::size_t star = std::string_view::npos;
  std::size_t after = 0;
  while (t < text.size()) {
    if (p < pattern.size() && (pattern[p] == text[t] || pattern[p] == '?')) {
      ++p;
      ++t;
    } else if (p < pattern.size() && pattern[p] == '*') {
      star = p++;
      after = t;
    } else if (star != std::string_view::npos) {
      p = star + 1;
      t = ++after;
    } else {
      return false;
    }
  }
  while (p < pattern.size() && pattern[p] == '*') ++p;
  return p == pattern.size();
}

}  // namespace

bool is_counter_name(std::string_view name) {
  return is_one_of(kCounterNames, joined_words(words_of(name)));
}

bool names_a_sensor(std::string_view name) {
  constexpr std::array<std::string_view, 9> kNames = {"imu",      "imuid",    "imunumber",
                                                      "imuindex", "sensorid", "sensornumber",
                                                      "deviceid", "instance", "inst"};
  return name == "I" || is_one_of(kNames, joined_words(words_of(name)));  // "I" of ArduPilot
}

bool is_norm_name(std::string_view name) {
  constexpr std::array<std::string_view, 5> kNorms = {"absolute", "norm", "magnitude", "resultant",
                                                      "modulus"};
  const std::vector<std::string> words = words_of(name);
  return std::any_of(words.begin(), words.end(),
                     [&](const std::string& word) { return is_one_of(kNorms, word); });
}

Role role_of(std::string_view name) {
  std::vector<std::string> words = words_of(name);
  if (words.size() > 1)
    std::erase_if(words, [](const std::string& word) { return is_one_of(kAttributes, word); });
  order_unit(words);
  const UnitWords* const stated = take_unit(words);
  std::string device;
  if (words.size() == 2 && is_device(words.front())) {
    device = words.front();  // "imu0_gx"
    words.erase(words.begin());
  }
  const std::string text = joined_words(words);
  if (text.size() > 1 && is_axis(text.back())) {
    // "gyro2_x": the number of the sensor may stand behind.
    const std::string_view before = std::string_view(text).substr(0, text.size() - 1);
    std::size_t letters = before.size();
    const Stem* stem = stem_of(before);
    if (stem == nullptr) {
      letters = before.find_last_not_of("0123456789") + 1;
      stem = stem_of(before.substr(0, letters));
    }
    const bool own = stated != nullptr && stem != nullptr && stated->quantity == stem->quantity;
    if (stem != nullptr && stem->quantity != Quantity::kTemperature)
      return {stem->quantity, text.back(), stem->increment, own ? stated->unit : stem->unit,
              device + std::string(before.substr(0, letters - stem->text.size())) +
                  std::string(before.substr(letters))};
  }
  const Stem* const stem = stem_of(text);
  if (stem == nullptr || stem->whole) return {};
  const bool own = stated != nullptr && stated->quantity == stem->quantity;
  return {stem->quantity, ' ', stem->increment, own ? stated->unit : stem->unit, {}};
}

std::string common_name(const Role& role) {
  std::string out;
  switch (role.quantity) {
    case Quantity::kAngularRate:
      out = "gyro";
      break;
    case Quantity::kAcceleration:
      out = "acc";
      break;
    case Quantity::kMagneticFluxDensity:
      out = "mag";
      break;
    case Quantity::kTemperature:
      return "temperature";
    case Quantity::kVoltage:
    case Quantity::kUnknown:
      return "";
  }
  if (role.axis != ' ') out += fmt::format("_{}", role.axis);
  return out;
}

bool matches(std::string_view pattern, std::string_view name) {
  if (glob(pattern, name)) return true;
  const Role role = role_of(name);
  const std::string common = common_name(role);
  if (common.empty()) return false;
  if (glob(pattern, common)) return true;
  // Another common name of the axis, which may be left open: gyr_x, wx, gyr_*. One that names no
  // sensor stands for every sensor's.
  std::string closed(pattern);
  const std::size_t open = closed.find('*');
  if (open != std::string::npos) closed[open] = role.axis;
  if (closed.find_first_of("*?") != std::string::npos) return false;
  const Role meant = role_of(closed);
  const bool same = meant.sensor.empty() || meant.sensor == role.sensor;
  return common_name(meant) == common && same;
}

std::vector<std::string> split_names(std::string_view names) {
  std::vector<std::string> out;
  while (!names.empty()) {
    const std::size_t comma = names.find(',');
    out.emplace_back(names.substr(0, comma));
    names.remove_prefix(comma == std::string_view::npos ? names.size() : comma + 1);
  }
  return out;
}

}  // namespace imunoise::recording
