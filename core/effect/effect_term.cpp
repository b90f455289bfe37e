#include "core/effect/effect_term.h"

#include <fmt/format.h>

#include <algorithm>
#include <cassert>
#include <cmath>

namespace imunoise {
namespace {

constexpr double kLargest = 1e15;

std::size_t place_of(const Effect& effect, std::string_view name) {
  const auto& all = effect.parameters;
  const auto found = std::find_if(all.begin(), all.end(),
                                  [&](const EffectParameter& one) { return one.name == name; });
  return static_cast<std::size_t>(found - all.begin());
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
  if (about.required && !(value > 0.0)) return fmt::format("{} is a number > 0", about.name);
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

double to_four_digits(double value) { return std::stod(fmt::format("{:.4g}", value)); }

// To the decimal place that is not coarser than `fine`.
double to_decimals(double value, double fine) {
  const double step = std::pow(10.0, std::floor(std::log10(fine)));
  return std::stod(fmt::format("{:.12g}", std::round(value / step) * step));
}

// Reads what stands in the brackets of a term; every failure names the place.
class EffectReader {
 public:
  EffectReader(const Effect& effect, const WrittenTerm& written, std::string_view text)
      : effect_(effect), written_(written), text_(text) {}

  Result<EffectTerm> term() const {
    EffectTerm out(effect_);
    std::vector<std::string_view> named;
    for (const Argument& one : written_.arguments) {
      if (std::find(named.begin(), named.end(), one.name) != named.end())
        return wrong(one.text, fmt::format("'{}' is given twice", one.name));
      named.push_back(one.name);
      if (auto done = argument(one, out); !done) return tl::unexpected(done.error());
    }
    if (effect_.witness && out.witness.empty())
      return wrong(written_.name, fmt::format("{} needs the name of a channel", effect_.name));
    for (const EffectParameter& one : effect_.parameters) {
      if (one.required && !(out[one.name] > 0.0))
        return wrong(written_.name,
                     fmt::format("{} needs {}=…, a number > 0", effect_.name, one.name));
    }
    if (effect_.fault == nullptr) return out;
    const std::string_view fault = effect_.fault(out);
    if (fault.empty()) return out;
    return wrong(written_.name, fmt::format("{}: {}", print(out), fault));
  }

 private:
  Result<void> argument(const Argument& one, EffectTerm& to) const {
    const std::size_t place = place_of(effect_, one.name);
    const bool known = place < effect_.parameters.size();
    const bool flag = known && effect_.parameters[place].form == ParameterForm::kFlag;
    if (flag && one.sign.empty()) {
      to.values[place] = 1.0;
    } else if (known && !flag && one.sign == "=") {
      return value(one, effect_.parameters[place], to.values[place]);
    } else if (effect_.witness && to.witness.empty() && !known && !one.text.empty()) {
      to.witness = one.text;
    } else {
      return wrong(one.text, fmt::format("'{}' is not known here; {} takes {}", one.text,
                                         effect_.name, choices(effect_)));
    }
    return {};
  }

  Result<void> value(const Argument& one, const EffectParameter& about, double& to) const {
    const std::optional<double> number = number_in(one.value);
    const double least = about.lower < 0.0 ? -kLargest : 0.0;
    if (!number || *number < least || *number > kLargest)
      return wrong(one.value, fmt::format("'{}' is not a number from {} to 1e15", one.value,
                                          least < 0.0 ? "-1e15" : "0"));
    if (const std::string fault = fault_of(about, *number); !fault.empty())
      return wrong(one.value, fault);
    to = *number;
    return {};
  }

  tl::unexpected<Error> wrong(std::string_view place, const std::string& what) const {
    return tl::unexpected(model_error(text_, place, what));
  }

  const Effect& effect_;
  const WrittenTerm& written_;
  std::string_view text_;
};

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
    if (value == 0.0 || !std::isfinite(value)) continue;
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

EffectTerm shape_of(EffectTerm term) {
  for (std::size_t i = 0; i < term.values.size(); ++i) {
    const EffectParameter& about = term.effect->parameters[i];
    if (about.truth) term.values[i] = about.absent;
  }
  return term;
}

bool changes_noise(const Effect& effect) {
  return effect.own_noise != nullptr || effect.variance_course != nullptr;
}

Result<EffectTerm> read_effect(const Effect& effect, const WrittenTerm& written,
                               std::string_view text) {
  return EffectReader(effect, written, text).term();
}

}  // namespace imunoise
