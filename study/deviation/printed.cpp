#include "study/deviation/printed.h"

#include <fmt/format.h>

#include <algorithm>
#include <charconv>
#include <cmath>
#include <numbers>
#include <optional>

namespace imunoise::study {
namespace {

constexpr double kHour = 3600.0;  // s

void replace_every(std::string& text, std::string_view from, std::string_view to) {
  for (auto at = text.find(from); at != std::string::npos; at = text.find(from, at + to.size()))
    text.replace(at, from.size(), to);
}

std::string trimmed(std::string_view text) {
  const std::size_t first = text.find_first_not_of(' ');
  if (first == std::string_view::npos) return {};
  return std::string(text.substr(first, text.find_last_not_of(' ') - first + 1));
}

// A unit with its root split off: "deg/h", "h" of "(deg/h)/√h". No root: an empty second.
struct RootedUnit {
  std::string base;
  std::string root;
};

RootedUnit rooted(std::string unit) {
  for (const auto& [from, to] :
       std::initializer_list<std::pair<const char*, const char*>>{{" ", ""},
                                                                  {"sqrt(", "√("},
                                                                  {"rt-", "√"},
                                                                  {"rt(", "√("},
                                                                  {"/rt", "/√"},
                                                                  {"sqrt", "√"},
                                                                  {"hour", "h"},
                                                                  {"hr", "h"},
                                                                  {"sec", "s"},
                                                                  {"hz", "Hz"}})
    replace_every(unit, from, to);
  const std::size_t at = unit.find("√");
  if (at == std::string::npos) return {unit, ""};
  std::string root = unit.substr(at + std::string_view("√").size());
  std::erase_if(root, [](char c) { return c == '(' || c == ')'; });
  std::string base = unit.substr(0, at);
  while (!base.empty() && base.back() == '/') base.pop_back();
  if (base.size() > 2 && base.front() == '(' && base.back() == ')')
    base = base.substr(1, base.size() - 2);
  return {base, root};
}

// Factor to SI of a rate or an acceleration, or of its integral or its derivative over seconds.
struct Factor {
  double to_si = 1.0;
  int seconds = 0;  // power of s: 0 rate, 1 angle or velocity, -1 rate of the rate
};

std::optional<Factor> factor_of(const std::string& base, Quantity quantity) {
  const auto direct = [&](const std::string& unit) -> std::optional<double> {
    const auto parsed = parse_unit(unit);
    if (!parsed || parsed->quantity != quantity) return std::nullopt;
    return parsed->to_si;
  };
  if (const auto to_si = direct(base)) return Factor{*to_si, 0};
  if (const auto to_si = direct(base + "/s")) return Factor{*to_si, 1};
  for (const auto& [suffix, seconds] :
       std::initializer_list<std::pair<std::string, double>>{{"/s", 1.0}, {"/h", kHour}}) {
    if (!base.ends_with(suffix)) continue;
    if (const auto to_si = direct(base.substr(0, base.size() - suffix.size())))
      return Factor{*to_si / seconds, -1};
  }
  if (quantity == Quantity::kAngularRate && (base == "rad/s^2" || base == "rad/s²"))
    return Factor{1.0, -1};
  if (quantity == Quantity::kAcceleration && (base == "m/s^3" || base == "m/s³"))
    return Factor{1.0, -1};
  return std::nullopt;
}

// SI value of one unit of a coefficient: N in rate/√Hz = angle/√s, K in rate/√s = (rate/s)/√Hz.
std::optional<double> unit_value(Coefficient coefficient, const std::string& unit,
                                 Quantity quantity) {
  const RootedUnit split = rooted(unit);
  const auto factor = factor_of(split.base, quantity);
  if (!factor) return std::nullopt;
  if (coefficient == Coefficient::kBiasInstability)
    return split.root.empty() && factor->seconds == 0 ? std::optional(factor->to_si) : std::nullopt;
  const int wanted = coefficient == Coefficient::kRandomWalk ? 0 : -1;  // over √Hz
  if (split.root == "Hz")
    return factor->seconds == wanted ? std::optional(factor->to_si) : std::nullopt;
  if (factor->seconds != wanted + 1) return std::nullopt;
  if (split.root == "s") return factor->to_si;
  return split.root == "h" ? std::optional(factor->to_si / std::sqrt(kHour)) : std::nullopt;
}

std::optional<Coefficient> coefficient_called(std::string name) {
  std::transform(name.begin(), name.end(), name.begin(),
                 [](unsigned char c) { return static_cast<char>(std::toupper(c)); });
  if (name == "N" || name == "ARW" || name == "VRW") return Coefficient::kRandomWalk;
  if (name == "B" || name == "BI") return Coefficient::kBiasInstability;
  if (name == "K" || name == "RRW") return Coefficient::kRateRandomWalk;
  return std::nullopt;
}

Result<PrintedFigure> parse_figure(const std::string& text, Quantity quantity) {
  const std::size_t equals = text.find('=');
  const auto coefficient = equals == std::string::npos
                               ? std::nullopt
                               : coefficient_called(trimmed(text.substr(0, equals)));
  if (!coefficient)
    return fail(fmt::format("'{}' is not N=, B= or K= with a value and a unit", text));
  const std::string rest = trimmed(text.substr(equals + 1));
  double value = 0.0;
  const auto [end, error] = std::from_chars(rest.data(), rest.data() + rest.size(), value);
  if (error != std::errc() || !std::isfinite(value) || !(value > 0.0))
    return fail(fmt::format("'{}': the value is not a number above zero", text));
  const std::string unit = trimmed(rest.substr(static_cast<std::size_t>(end - rest.data())));
  const auto one = unit_value(*coefficient, unit, quantity);
  if (!one) {
    const CoefficientUnits known = coefficient_units(*coefficient, quantity);
    if (unit.empty())
      return fail(fmt::format("'{}' has no unit; add {} or {}", text, known.datasheet, known.si));
    return fail(fmt::format("'{}': '{}' is not a unit of {}; write {} or {}", text, unit,
                            known.symbol, known.datasheet, known.si));
  }
  return PrintedFigure{*coefficient, value * *one, rest};
}

}  // namespace

Result<PrintedFigures> parse_printed(std::string_view text, Quantity quantity) {
  PrintedFigures out{quantity, {}};
  for (std::size_t at = 0; at <= text.size();) {
    const std::size_t comma = std::min(text.find(',', at), text.size());
    const std::string one = trimmed(text.substr(at, comma - at));
    at = comma + 1;
    auto figure = parse_figure(one, quantity);
    if (!figure) return tl::unexpected(figure.error());
    for (const PrintedFigure& before : out.figures)
      if (before.coefficient == figure->coefficient)
        return fail(fmt::format("'{}': this figure is given twice", one));
    out.figures.push_back(std::move(*figure));
  }
  return out;
}

Model printed_model(const PrintedFigures& printed, Hertz rate) {
  Model out;
  for (const PrintedFigure& one : printed.figures) {
    const double squared = one.value * one.value;
    if (one.coefficient == Coefficient::kRandomWalk)
      out.terms.emplace_back(WhiteNoise{squared * rate.value});
    else if (one.coefficient == Coefficient::kBiasInstability)
      out.terms.emplace_back(Flicker{squared});
    else
      out.terms.emplace_back(RandomWalk{squared / rate.value});
  }
  return out;
}

}  // namespace imunoise::study
