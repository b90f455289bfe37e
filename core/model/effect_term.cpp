#include "core/model/effect_term.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cctype>
#include <charconv>
#include <cmath>

namespace imunoise {
namespace {

struct NumberField {
  std::string_view name;
  double EffectTerm::*member;
  bool required;
};
struct FlagField {
  std::string_view name;
  bool EffectTerm::*member;
};
struct Spelling {
  EffectKind kind;
  std::string_view name;
  bool witness;
  std::vector<NumberField> numbers;
  std::vector<FlagField> flags;
};

const std::vector<Spelling>& spellings() {
  using T = EffectTerm;
  static const std::vector<Spelling> all{
      {EffectKind::kRamp, "ramp", false, {}, {{"own", &T::own}}},
      {EffectKind::kWarmUp, "warm_up", false, {{"tau", &T::tau, true}}, {{"own", &T::own}}},
      {EffectKind::kLine,
       "line",
       false,
       {{"f", &T::frequency, true}, {"harmonics", &T::harmonics, false}},
       {}},
      {EffectKind::kStep,
       "step",
       false,
       {{"replicate", &T::replicate, true}, {"t", &T::time, true}},
       {}},
      {EffectKind::kWitness,
       "witness",
       true,
       {{"lag", &T::lag, false}, {"from", &T::from, false}, {"to", &T::to, false}},
       {{"quadratic", &T::quadratic}, {"derivative", &T::derivative}, {"own", &T::own}}},
      {EffectKind::kModulated, "modulated", true, {}, {}},
      {EffectKind::kTelegraph, "telegraph", false, {}, {}},
      {EffectKind::kOutliers, "outliers", false, {{"above", &T::above, true}}, {}},
      {EffectKind::kOwnPowers, "own_powers", false, {}, {}},
  };
  return all;
}

const Spelling& spelling_of(EffectKind kind) {
  return *std::find_if(spellings().begin(), spellings().end(),
                       [&](const Spelling& one) { return one.kind == kind; });
}

std::string_view trimmed(std::string_view text) {
  constexpr std::string_view kSpace = " \t\n";
  const std::size_t begin = text.find_first_not_of(kSpace);
  if (begin == std::string_view::npos) return {};
  return text.substr(begin, text.find_last_not_of(kSpace) - begin + 1);
}

// Parts of a text between separators that stand outside brackets.
std::vector<std::string_view> split(std::string_view text, char separator) {
  std::vector<std::string_view> out;
  int depth = 0;
  std::size_t begin = 0;
  for (std::size_t i = 0; i < text.size(); ++i) {
    if (text[i] == '(' || text[i] == '[') ++depth;
    if (text[i] == ')' || text[i] == ']') --depth;
    if (text[i] != separator || depth != 0) continue;
    out.push_back(text.substr(begin, i - begin));
    begin = i + 1;
  }
  out.push_back(text.substr(begin));
  return out;
}

tl::unexpected<Error> wrong(std::string_view term, std::string_view what) {
  return tl::unexpected(Error{fmt::format("{}: {}", trimmed(term), what)});
}

Result<double> number(std::string_view text) {
  double out = 0.0;
  const auto [end, code] = std::from_chars(text.data(), text.data() + text.size(), out);
  constexpr double kLargest = 1e15;
  if (code != std::errc() || end != text.data() + text.size() || !(out >= 0.0 && out <= kLargest)) {
    return tl::unexpected(Error{fmt::format("'{}' is not a number from 0 to 1e15", text)});
  }
  return out;
}

std::string choices(const Spelling& about) {
  std::string out = about.witness ? "the name of a channel" : "";
  const auto add = [&](std::string_view name) {
    out += fmt::format("{}{}", out.empty() ? "" : ", ", name);
  };
  for (const NumberField& field : about.numbers) add(fmt::format("{}=…", field.name));
  for (const FlagField& field : about.flags) add(field.name);
  return out.empty() ? "nothing" : out;
}

Result<EffectTerm> read_effect(const Spelling& about, std::string_view whole,
                               std::string_view inside) {
  EffectTerm out{.kind = about.kind};
  std::vector<std::string_view> given;
  std::vector<std::string_view> named;
  if (!trimmed(inside).empty()) given = split(inside, ',');
  for (std::string_view& one : given) {
    one = trimmed(one);
    const std::size_t equals = one.find('=');
    const std::string_view name = trimmed(one.substr(0, equals));
    if (std::find(named.begin(), named.end(), name) != named.end())
      return wrong(whole, fmt::format("'{}' is given twice", name));
    named.push_back(name);
    const auto field = std::find_if(about.numbers.begin(), about.numbers.end(),
                                    [&](const NumberField& f) { return f.name == name; });
    if (equals != std::string_view::npos && field != about.numbers.end()) {
      const Result<double> value = number(trimmed(one.substr(equals + 1)));
      if (!value) return wrong(whole, value.error().message);
      out.*(field->member) = *value;
      continue;
    }
    const auto flag = std::find_if(about.flags.begin(), about.flags.end(),
                                   [&](const FlagField& f) { return f.name == one; });
    if (flag != about.flags.end()) {
      out.*(flag->member) = true;
    } else if (about.witness && out.witness.empty() && !one.empty()) {
      out.witness = one;
    } else {
      return wrong(whole, fmt::format("'{}' is not known here; it takes {}", one, choices(about)));
    }
  }
  for (const NumberField& field : about.numbers) {
    if (field.required && !(out.*(field.member) > 0.0))
      return wrong(whole, fmt::format("needs {}=…, a number > 0", field.name));
  }
  if (about.witness && out.witness.empty()) return wrong(whole, "needs the name of a channel");
  if (out.harmonics != std::floor(out.harmonics) || out.harmonics < 1.0 || out.harmonics > 50.0)
    return wrong(whole, "harmonics is a whole number from 1 to 50");
  if (out.replicate != std::floor(out.replicate))
    return wrong(whole, "replicate is a whole number, counted from 1");
  if (!(out.from < out.to)) return wrong(whole, "from must lie below to");
  constexpr double kLeastAbove = 3.0;
  if (about.kind == EffectKind::kOutliers && out.above < kLeastAbove)
    return wrong(whole, "above is at least 3 standard deviations: less is noise");
  return out;
}

std::string known_effects() {
  std::string out;
  for (const Spelling& one : spellings())
    out += fmt::format("{}{}", out.empty() ? "" : ", ", one.name);
  return out;
}

const Spelling* effect_called(std::string_view term) {
  std::string name(trimmed(term.substr(0, term.find('('))));
  std::transform(name.begin(), name.end(), name.begin(),
                 [](unsigned char c) { return static_cast<char>(std::tolower(c)); });
  const auto found = std::find_if(spellings().begin(), spellings().end(),
                                  [&](const Spelling& one) { return one.name == name; });
  return found == spellings().end() ? nullptr : &*found;
}

std::string joined(const std::string& noise, const std::vector<EffectTerm>& effects) {
  std::string out = noise;
  for (const EffectTerm& term : effects) out += (out.empty() ? "" : " + ") + print(term);
  return out;
}

}  // namespace

Result<FullModel> parse_full_model(std::string_view text, Hertz rate) {
  FullModel out;
  std::string noise;
  for (const std::string_view term : split(text, '+')) {
    const Spelling* about = effect_called(term);
    if (about == nullptr) {
      noise += (noise.empty() ? "" : "+") + std::string(term);
      continue;
    }
    const std::size_t open = term.find('(');
    std::string_view inside;
    if (open != std::string_view::npos) {
      const std::size_t close = term.rfind(')');
      if (close == std::string_view::npos || !trimmed(term.substr(close + 1)).empty())
        return wrong(term, "expected ')' at its end");
      inside = term.substr(open + 1, close - open - 1);
    }
    Result<EffectTerm> effect = read_effect(*about, term, inside);
    if (!effect) return tl::unexpected(effect.error());
    if (std::find(out.effects.begin(), out.effects.end(), *effect) != out.effects.end())
      return wrong(term, "is in the model already");
    out.effects.push_back(std::move(*effect));
  }
  Result<Model> read = parse_model(noise, rate);
  if (!read && read.error().message.find("unknown process") != std::string::npos)
    return tl::unexpected(
        Error{fmt::format("{}\n  effects: {}", read.error().message, known_effects())});
  if (!read) return tl::unexpected(read.error());
  out.noise = std::move(*read);
  const auto is_drift = [](const Term& term) {
    return std::holds_alternative<Drift>(term.process);
  };
  if (std::erase_if(out.noise.terms, is_drift) > 0)
    out.effects.push_back({.kind = EffectKind::kRamp, .own = true});
  if (out.noise.terms.empty())
    return tl::unexpected(Error{"a model needs at least one noise process, such as WN"});
  return out;
}

EffectTerm rounded(EffectTerm term, double frequency_error, Hertz rate) {
  // To the decimal place that is not coarser than `fine`.
  const auto to_decimals = [](double value, double fine) {
    const double step = std::pow(10.0, std::floor(std::log10(fine)));
    return std::stod(fmt::format("{:.12g}", std::round(value / step) * step));
  };
  for (double EffectTerm::*const member : {&EffectTerm::tau, &EffectTerm::lag, &EffectTerm::from,
                                           &EffectTerm::to, &EffectTerm::above}) {
    const double value = term.*member;
    if (value > 0.0 && std::isfinite(value)) term.*member = std::stod(fmt::format("{:.4g}", value));
  }
  if (term.frequency > 0.0 && frequency_error > 0.0)
    term.frequency = to_decimals(term.frequency, frequency_error / 50.0);
  if (term.time > 0.0) term.time = to_decimals(term.time, 1.0 / rate.value);
  return term;
}

std::string print(const EffectTerm& term) {
  const Spelling& about = spelling_of(term.kind);
  const EffectTerm absent;
  std::string inside = term.witness;
  const auto add = [&](const std::string& text) { inside += (inside.empty() ? "" : ", ") + text; };
  for (const NumberField& field : about.numbers) {
    if (term.*(field.member) != absent.*(field.member))
      add(fmt::format("{}={}", field.name, term.*(field.member)));
  }
  for (const FlagField& field : about.flags) {
    if (term.*(field.member)) add(std::string(field.name));
  }
  return inside.empty() ? std::string(about.name) : fmt::format("{}({})", about.name, inside);
}

std::string print(const FullModel& model) { return joined(print(model.noise), model.effects); }

std::string print_with_values(const FullModel& model) {
  return joined(print_with_values(model.noise), model.effects);
}

}  // namespace imunoise
