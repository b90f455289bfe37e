#include "core/effect/effect_term.h"

#include <fmt/format.h>

#include <algorithm>
#include <cassert>
#include <charconv>
#include <cmath>

#include "core/effect/text.h"

namespace imunoise {
namespace {

constexpr double kLargest = 1e15;

std::size_t place_of(const Effect& effect, std::string_view name) {
  const auto& all = effect.parameters;
  const auto found = std::find_if(all.begin(), all.end(),
                                  [&](const EffectParameter& one) { return one.name == name; });
  return static_cast<std::size_t>(found - all.begin());
}

Result<double> number(std::string_view text, const EffectParameter& about) {
  double out = 0.0;
  const auto [end, code] = std::from_chars(text.data(), text.data() + text.size(), out);
  const bool read = code == std::errc() && end == text.data() + text.size();
  const double least = about.lower < 0.0 ? -kLargest : 0.0;
  if (!read || !(out >= least && out <= kLargest)) {
    return tl::unexpected(Error{
        fmt::format("'{}' is not a number from {} to 1e15", text, least < 0.0 ? "-1e15" : "0")});
  }
  return out;
}

std::string choices(const Effect& effect) {
  std::string out = effect.witness ? "the name of a channel" : "";
  for (const EffectParameter& one : effect.parameters) {
    out += fmt::format("{}{}{}", out.empty() ? "" : ", ", one.name,
                       one.form == ParameterForm::kFlag ? "" : "=…");
  }
  return out.empty() ? "nothing" : out;
}

// What is wrong with a value; empty where nothing is.
std::string fault_of(const EffectParameter& about, double value) {
  if (about.required && !(value > 0.0)) return fmt::format("needs {}=…, a number > 0", about.name);
  if (value == about.absent) return {};
  const bool bounded = about.upper < kLargest;
  if (about.form == ParameterForm::kWholeNumber) {
    if (value == std::floor(value) && value >= about.lower && value <= about.upper) return {};
    if (!bounded) return fmt::format("{} is a whole number, counted from 1", about.name);
    return fmt::format("{} is a whole number from {} to {}", about.name, about.lower, about.upper);
  }
  if (value < about.lower) return fmt::format("{} is at least {}", about.name, about.lower);
  if (bounded && value > about.upper)
    return fmt::format("{} is at most {}", about.name, about.upper);
  return {};
}

tl::unexpected<Error> wrong(std::string_view term, std::string_view what) {
  return tl::unexpected(Error{fmt::format("{}: {}", trimmed(term), what)});
}

double to_four_digits(double value) { return std::stod(fmt::format("{:.4g}", value)); }

// To the decimal place that is not coarser than `fine`.
double to_decimals(double value, double fine) {
  const double step = std::pow(10.0, std::floor(std::log10(fine)));
  return std::stod(fmt::format("{:.12g}", std::round(value / step) * step));
}

}  // namespace

EffectTerm::EffectTerm(const Effect& of, std::string channel,
                       std::initializer_list<std::pair<std::string_view, double>> given_values)
    : effect(&of), witness(std::move(channel)) {
  for (const EffectParameter& one : of.parameters) values.push_back(one.absent);
  for (const auto& [name, value] : given_values) set(name, value);
}

double EffectTerm::operator[](std::string_view parameter) const {
  const std::size_t place = place_of(*effect, parameter);
  assert(place < values.size());
  return values[place];
}

void EffectTerm::set(std::string_view parameter, double value) {
  const std::size_t place = place_of(*effect, parameter);
  assert(place < values.size());
  values[place] = value;
}

bool EffectTerm::given(std::size_t parameter) const {
  return values[parameter] != effect->parameters[parameter].absent;
}

std::string print(const EffectTerm& term) {
  std::string inside = term.witness;
  for (std::size_t i = 0; i < term.values.size(); ++i) {
    if (!term.given(i)) continue;
    const EffectParameter& about = term.effect->parameters[i];
    if (!inside.empty()) inside += ", ";
    inside += about.form == ParameterForm::kFlag ? std::string(about.name)
                                                 : fmt::format("{}={}", about.name, term[i]);
  }
  const std::string_view name = term.effect->name;
  return inside.empty() ? std::string(name) : fmt::format("{}({})", name, inside);
}

EffectTerm rounded(EffectTerm term, double shape_error, Hertz rate) {
  for (std::size_t i = 0; i < term.values.size(); ++i) {
    double& value = term.values[i];
    if (!(value > 0.0) || !std::isfinite(value)) continue;
    switch (term.effect->parameters[i].rounding) {
      case Rounding::kNone:
        break;
      case Rounding::kFourDigits:
        value = to_four_digits(value);
        break;
      case Rounding::kByError:
        if (shape_error > 0.0) value = to_decimals(value, shape_error / 50.0);
        break;
      case Rounding::kBySample:
        value = to_decimals(value, 1.0 / rate.value);
        break;
    }
  }
  return term;
}

Result<EffectTerm> parse_effect(const Effect& effect, std::string_view whole,
                                std::string_view inside) {
  EffectTerm out(effect);
  std::vector<std::string_view> named;
  std::vector<std::string_view> items;
  if (!trimmed(inside).empty()) items = split_outside_brackets(inside, ',');
  for (std::string_view one : items) {
    one = trimmed(one);
    const std::size_t equals = one.find('=');
    const std::string_view name = trimmed(one.substr(0, equals));
    if (std::find(named.begin(), named.end(), name) != named.end())
      return wrong(whole, fmt::format("'{}' is given twice", name));
    named.push_back(name);
    const std::size_t place = place_of(effect, name);
    const bool valued = equals != std::string_view::npos;
    const bool known = place < effect.parameters.size() &&
                       valued == (effect.parameters[place].form != ParameterForm::kFlag);
    if (known && valued) {
      const Result<double> value =
          number(trimmed(one.substr(equals + 1)), effect.parameters[place]);
      if (!value) return wrong(whole, value.error().message);
      out.values[place] = *value;
    } else if (known) {
      out.values[place] = 1.0;
    } else if (effect.witness && out.witness.empty() && !one.empty()) {
      out.witness = one;
    } else {
      return wrong(whole,
                   fmt::format("unknown parameter '{}'; known are {}", one, choices(effect)));
    }
  }
  if (effect.witness && out.witness.empty()) return wrong(whole, "needs the name of a channel");
  for (std::size_t i = 0; i < out.values.size(); ++i) {
    const std::string fault = fault_of(effect.parameters[i], out[i]);
    if (!fault.empty()) return wrong(whole, fault);
  }
  if (effect.fault != nullptr) {
    if (const std::string_view fault = effect.fault(out); !fault.empty())
      return wrong(whole, fault);
  }
  return out;
}

}  // namespace imunoise
