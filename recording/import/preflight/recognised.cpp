#include "recording/import/preflight/recognised.h"

#include <fmt/core.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <string_view>

#include "recording/import/table/names.h"

namespace imunoise::recording {
namespace {

constexpr std::size_t kShown = 12;  // names of a group

std::string_view plural_of(Quantity quantity) {
  switch (quantity) {
    case Quantity::kAngularRate:
      return "angular rates";
    case Quantity::kAcceleration:
      return "accelerations";
    case Quantity::kMagneticFluxDensity:
      return "magnetic fields";
    case Quantity::kTemperature:
      return "temperatures";
    case Quantity::kVoltage:
      return "voltages";
    case Quantity::kUnknown:
      break;
  }
  return "numbers";
}

// "deg/s (stated)"; empty where neither the user nor the file nor the name told it.
std::string unit_in_words(const Column& column, const Unit& unit,
                          const std::vector<UnitRule>& rules) {
  if (unit.quantity == Quantity::kUnknown) return "no unit";
  const bool ruled = std::any_of(rules.begin(), rules.end(), [&](const UnitRule& one) {
    return matches(one.pattern, column.name);
  });
  const bool stated = !column.unit.empty() && column.unit != "-";
  if (ruled) return unit.symbol + " (--unit)";
  if (stated) return unit.symbol + " (stated)";
  if (role_of(column.name).unit.empty()) return "";
  return unit.symbol + " (by convention of the names)";
}

struct Group {
  Quantity quantity;
  std::string unit;
  std::vector<std::string> names;
};

}  // namespace

std::vector<std::string> channels_in_words(std::span<const Column> columns,
                                           std::span<const Unit> units,
                                           const std::vector<UnitRule>& rules) {
  std::vector<Group> groups;
  for (std::size_t c = 0; c < columns.size(); ++c) {
    const bool known = units[c].quantity != Quantity::kUnknown;
    const Quantity quantity = known ? units[c].quantity : role_of(columns[c].name).quantity;
    const std::string unit = unit_in_words(columns[c], units[c], rules);
    if (unit.empty()) continue;
    auto at = std::find_if(groups.begin(), groups.end(), [&](const Group& one) {
      return one.quantity == quantity && one.unit == unit;
    });
    if (at == groups.end()) at = groups.insert(at, {quantity, unit, {}});
    at->names.push_back(columns[c].name);
  }
  std::vector<std::string> out;
  for (Group& one : groups) {
    const std::size_t more = one.names.size() - std::min(kShown, one.names.size());
    one.names.resize(one.names.size() - more);
    out.push_back(fmt::format("{} {}{}: {}", plural_of(one.quantity), fmt::join(one.names, ", "),
                              more > 0 ? fmt::format(" and {} more", more) : "", one.unit));
  }
  return out;
}

}  // namespace imunoise::recording
