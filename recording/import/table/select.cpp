#include "recording/import/table/select.h"

#include <fmt/core.h>

#include <algorithm>
#include <cmath>
#include <map>
#include <optional>
#include <set>
#include <string_view>
#include <unordered_map>

#include "core/support/nearest_word.h"
#include "recording/import/table/names.h"

namespace imunoise::recording {
namespace {

// A hostile file may offer thousands of names: a message shows the first ones.
std::string listed(const std::vector<Offer>& offers) {
  constexpr std::size_t shown = 40;
  std::string out;
  for (std::size_t i = 0; i < std::min(offers.size(), shown); ++i) {
    out += out.empty() ? "" : ", ";
    out += offers[i].name;
  }
  if (offers.size() > shown) out += fmt::format(", and {} more", offers.size() - shown);
  return out.empty() ? "none" : out;
}

// The column of that name; else those that match it.
std::vector<std::size_t> called(const std::string& name, const std::vector<Offer>& offers) {
  std::vector<std::size_t> matching;
  for (std::size_t i = 0; i < offers.size(); ++i) {
    if (offers[i].name == name) return {i};
    if (matches(name, offers[i].name)) matching.push_back(i);
  }
  return matching;
}

// The axes of motion of the first chosen one's sensor, as names tell it, that are not chosen: of
// each the nearest column.
std::vector<std::size_t> axes_beside(const std::vector<std::size_t>& chosen,
                                     const std::vector<Offer>& offers) {
  std::optional<std::string> sensor;  // of the first chosen axis
  const auto axis_of = [&](std::size_t i) {
    const Role role = role_of(offers[i].name);
    const bool same = !sensor || role.sensor == *sensor;
    return of_inertia(role.quantity) && same && role.axis != ' ' ? common_name(role)
                                                                 : std::string();
  };
  const auto on_axis = std::find_if(chosen.begin(), chosen.end(),
                                    [&](std::size_t i) { return !axis_of(i).empty(); });
  if (on_axis == chosen.end()) return {};
  const std::size_t first = *on_axis;
  sensor = role_of(offers[first].name).sensor;
  const auto distance = [&](std::size_t i) { return i > first ? i - first : first - i; };
  std::map<std::string, std::size_t> nearest;
  std::set<std::string> known;
  for (const std::size_t i : chosen) known.insert(axis_of(i));
  for (std::size_t i = 0; i < offers.size(); ++i) {
    const std::string axis = axis_of(i);
    if (axis.empty() || known.contains(axis) || !offers[i].by_default) continue;
    const auto [at, is_new] = nearest.emplace(axis, i);
    if (!is_new && distance(i) < distance(at->second)) at->second = i;
  }
  std::vector<std::size_t> out;
  for (const auto& [axis, i] : nearest) out.push_back(i);
  return out;
}

// "did you mean 'gyro_x'? "
std::string nearest_of(const std::string& name, const std::vector<Offer>& offers) {
  std::vector<std::string> names;
  for (const Offer& one : offers) names.push_back(one.name);
  const std::string meant = did_you_mean(name, names);
  return meant.empty() ? "" : "; " + meant;
}

// What the file says of the unit, or the name.
Result<Unit> stated_unit(std::string_view text, const Role& role) {
  if (text.empty() || text == "-") {
    return role.unit.empty() ? Unit{"1", Quantity::kUnknown, 1.0} : parse_unit(role.unit);
  }
  // G is gauss, but some apps write it for g: no accelerometer measures gauss.
  const bool g = role.quantity == Quantity::kAcceleration;
  const bool gauss = role.quantity == Quantity::kMagneticFluxDensity;
  if (g && (text == "G" || text == "mG")) return parse_unit(text == "G" ? "g" : "mg");
  if (gauss && (text == "G" || text == "Gauss")) return parse_unit("gauss");
  return parse_unit(gauss && text == "mG" ? "mgauss" : text);
}

}  // namespace

Result<std::vector<std::size_t>> select_columns(std::string_view file,
                                                const std::vector<Offer>& offers,
                                                const ImportOptions& options) {
  const std::vector<std::string>& wanted = options.channels;
  if (offers.size() > kMaximumColumns) {
    return fail(fmt::format("{}: {} columns, more than the {} allowed; is the table transposed?",
                            file, offers.size(), kMaximumColumns));
  }
  std::vector<std::size_t> out;
  std::vector<bool> chosen(offers.size(), false);
  std::vector<std::string> named = wanted;
  if (options.beside) named.insert(named.end(), options.witnesses.begin(), options.witnesses.end());
  for (std::size_t i = 0; i < named.size(); ++i) {
    const std::string& name = named[i];
    const std::vector<std::size_t> found = called(name, offers);
    if (found.empty()) {
      const std::string_view option = i < wanted.size() ? "--channel" : "--witness";
      return fail(fmt::format("{}: no channel '{}' (it has: {}); choose with {}{}", file, name,
                              listed(offers), option, nearest_of(name, offers)));
    }
    for (const std::size_t index : found) {
      if (!chosen[index]) out.push_back(index);
      chosen[index] = true;
    }
  }
  for (std::size_t i = 0; i < offers.size() && (wanted.empty() || options.beside); ++i) {
    if (!offers[i].by_default || chosen[i]) continue;
    if (!options.beside || beside_them(offers[i], options)) out.push_back(i);
  }
  if (options.axes_to_judge && !wanted.empty()) {
    const auto axes = axes_beside(out, offers);
    out.insert(out.end(), axes.begin(), axes.end());
    for (std::size_t i = 0; i < offers.size(); ++i) {
      if (names_a_sensor(offers[i].name) && std::find(out.begin(), out.end(), i) == out.end())
        out.push_back(i);
    }
  }
  if (out.empty())
    return fail(fmt::format("{}: no channel of samples (found: {})", file, listed(offers)));
  std::unordered_map<std::string_view, std::size_t> times;  // that each name is offered
  for (const Offer& one : offers) ++times[one.name];
  for (const std::size_t index : out) {
    if (times[offers[index].name] > 1) {
      return fail(fmt::format("{}: two columns are named '{}'; rename one of them", file,
                              offers[index].name));
    }
  }
  return out;
}

bool beside_them(const Offer& offer, const ImportOptions& options) {
  const auto& only = options.witnesses;
  if (!only.empty()) return std::find(only.begin(), only.end(), offer.name) != only.end();
  return offer.unit != "ticks";
}

Result<Unit> resolve_unit(std::string_view file, std::string_view channel, std::string_view text,
                          const ImportOptions& options) {
  const Role role = role_of(channel);
  const auto rule =
      std::find_if(options.units.begin(), options.units.end(),
                   [&](const UnitRule& one) { return matches(one.pattern, channel); });
  if (rule != options.units.end()) {
    const Quantity quantity = rule->unit.quantity;
    if (role.quantity != Quantity::kUnknown && quantity != Quantity::kUnknown &&
        quantity != role.quantity) {
      return fail(fmt::format(
          "{}: --unit {} does not suit channel {}; give each kind its own, such as --unit "
          "'gyro_*=deg/s,acc_*=g'",
          file, rule->unit.symbol, channel));
    }
    return rule->unit;
  }
  Result<Unit> unit = stated_unit(text, role);
  const auto& named = options.channels;
  const bool only_beside =
      options.beside && std::find(named.begin(), named.end(), channel) == named.end();
  if (!unit && only_beside) return Unit{std::string(text), Quantity::kUnknown, 1.0};
  if (!unit) {
    return fail(fmt::format("{}: channel {}: {}; correct the file or state it with --unit", file,
                            channel, unit.error().message));
  }
  return unit;
}

Result<Hertz> checked_rate(std::string_view file, std::string_view where, double hertz) {
  if (!std::isfinite(hertz) || hertz <= 0.0) {
    return fail(fmt::format("{}: {} states a sampling rate of {} Hz; correct it or give --rate HZ",
                            file, where, hertz));
  }
  return Hertz{hertz};
}

}  // namespace imunoise::recording
