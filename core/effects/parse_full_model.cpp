#include "core/effects/parse_full_model.h"

#include <fmt/format.h>

#include <algorithm>
#include <cctype>
#include <cmath>

#include "core/effect/text.h"
#include "core/effects/known_effects.h"

namespace imunoise {
namespace {

std::string known_names() {
  std::string out;
  for (const Effect* one : known_effects())
    out += fmt::format("{}{}", out.empty() ? "" : ", ", one->name);
  return out;
}

const Effect* effect_of(std::string_view term) {
  std::string name(trimmed(term.substr(0, term.find('('))));
  std::transform(name.begin(), name.end(), name.begin(),
                 [](unsigned char c) { return static_cast<char>(std::tolower(c)); });
  return effect_called(name);
}

Result<EffectTerm> read_effect(const Effect& effect, std::string_view term) {
  const std::size_t open = term.find('(');
  if (open == std::string_view::npos) return parse_effect(effect, term, {});
  const std::size_t close = term.rfind(')');
  if (close == std::string_view::npos || close < open || !trimmed(term.substr(close + 1)).empty())
    return fail(fmt::format("{}: expected ')' at its end", trimmed(term)));
  return parse_effect(effect, term, term.substr(open + 1, close - open - 1));
}

// DR is ramp(own), in whose grammar its size is the slope per second.
void move_ramps(FullModel& model, Hertz rate) {
  const auto is_ramp = [](const Term& term) {
    return std::holds_alternative<RateRamp>(term.process);
  };
  for (const Term& term : model.noise.terms) {
    if (!is_ramp(term)) continue;
    EffectTerm ramp(effect_named("ramp"), "", {{"own", 1.0}});
    if (term.given[0]) ramp.set("slope", std::sqrt(values(term.process)[0]) * rate.value);
    const bool known =
        std::find(model.effects.begin(), model.effects.end(), ramp) != model.effects.end();
    if (!known) model.effects.push_back(std::move(ramp));
  }
  std::erase_if(model.noise.terms, is_ramp);
}

}  // namespace

Result<FullModel> parse_full_model(std::string_view text, Hertz rate) {
  FullModel out;
  std::string noise;
  for (const std::string_view term : split_outside_brackets(text, '+')) {
    const Effect* const effect = effect_of(term);
    if (effect == nullptr) {
      noise += (noise.empty() ? "" : "+") + std::string(term);
      continue;
    }
    Result<EffectTerm> read = read_effect(*effect, term);
    if (!read) return tl::unexpected(read.error());
    if (std::find(out.effects.begin(), out.effects.end(), *read) != out.effects.end())
      return fail(fmt::format("{}: is in the model already", trimmed(term)));
    out.effects.push_back(std::move(*read));
  }
  Result<Model> read = parse_model(noise, rate);
  if (!read && read.error().message.find("unknown process") != std::string::npos)
    return fail(fmt::format("{}\n  effects: {}", read.error().message, known_names()));
  if (!read) return tl::unexpected(read.error());
  out.noise = std::move(*read);
  move_ramps(out, rate);
  if (out.noise.terms.empty()) return fail("a model needs at least one noise process, such as WN");
  return out;
}

}  // namespace imunoise
