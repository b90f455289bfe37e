#include "core/effects/parse_full_model.h"

#include <fmt/format.h>

#include <algorithm>
#include <cctype>

#include "core/effects/known_effects.h"

namespace imunoise {
namespace {

std::vector<std::string> known_effect_names() {
  std::vector<std::string> out;
  for (const Effect* one : known_effects()) out.emplace_back(one->name);
  return out;
}

const Effect* effect_of(std::string_view name) {
  std::string lower(name);
  std::transform(lower.begin(), lower.end(), lower.begin(),
                 [](unsigned char c) { return static_cast<char>(std::tolower(c)); });
  return effect_called(lower);
}

// Why this reader of models cannot take an effect; empty where it can.
std::string refusal(const Effect& effect, const Grammar& grammar) {
  if (!grammar.no_effects.empty())
    return fmt::format("{} is an effect, which cannot be here: {}", effect.name,
                       grammar.no_effects);
  if (changes_noise(effect) && !grammar.one_noise.empty())
    return fmt::format("{} changes the noise itself, and {}", effect.name, grammar.one_noise);
  return {};
}

Result<void> add_effect(const Effect& effect, const WrittenTerm& written, std::string_view text,
                        const Grammar& grammar, std::vector<EffectTerm>& to) {
  const auto wrong = [&](std::string_view place, const std::string& what) {
    return tl::unexpected(model_error(text, place, what));
  };
  if (const std::string why = refusal(effect, grammar); !why.empty())
    return wrong(written.name, why);
  if (written.count > 1) return wrong(written.text, "an effect stands once");
  if (written.sharing) return wrong(*written.sharing, "sensors share processes, not effects");
  Result<EffectTerm> read = read_effect(effect, written, text);
  if (!read) return tl::unexpected(read.error());
  const auto same = [&](const EffectTerm& one) { return shape_of(one) == shape_of(*read); };
  if (std::any_of(to.begin(), to.end(), same))
    return wrong(written.name, fmt::format("{} is in the model already", print(*read)));
  to.push_back(std::move(*read));
  return {};
}

bool same_effects(const FullModel& one, const FullModel& other) {
  return std::is_permutation(
      one.effects.begin(), one.effects.end(), other.effects.begin(), other.effects.end(),
      [](const EffectTerm& a, const EffectTerm& b) { return shape_of(a) == shape_of(b); });
}

bool same_noise(const Model& a, const Model& b) {
  return std::is_permutation(a.terms.begin(), a.terms.end(), b.terms.begin(), b.terms.end());
}

}  // namespace

Result<FullModel> parse_full_model(std::string_view text, Hertz rate, const Grammar& grammar) {
  const auto terms = split_model(text);
  if (!terms) return tl::unexpected(terms.error());
  FullModel out;
  for (const WrittenTerm& one : *terms) {
    const Effect* const effect = effect_of(one.name);
    if (effect == nullptr && !one.name.empty() && !is_process(one.name))
      return tl::unexpected(
          model_error(text, one.name, unknown_term(one.name, known_effect_names())));
    auto done = effect != nullptr ? add_effect(*effect, one, text, grammar, out.effects)
                                  : add_process(one, text, rate, grammar, out.noise);
    if (!done) return tl::unexpected(done.error());
  }
  if (out.noise.terms.empty())
    return tl::unexpected(model_error(text, text.substr(text.size()),
                                      "a model needs at least one noise process, such as WN"));
  return out;
}

Result<Model> parse_noise_model(std::string_view text, Hertz rate, const Grammar& grammar) {
  auto out = parse_full_model(text, rate, grammar);
  if (!out) return tl::unexpected(out.error());
  return std::move(out->noise);
}

Grammar grammar_of_arrays() {
  return {.sharing = true,
          .no_effects =
              "several sensors are modelled by noise alone; fit the effects of one sensor "
              "with imunoise fit, and give imunoise mixed its covariates as --regress"};
}

Grammar grammar_over_covariate() {
  return {.trends = true,
          .no_effects =
              "imunoise dynamic measures noise in the bins of a covariate, where an "
              "effect has no course in time; mark what follows the covariate by ~"};
}

Grammar grammar_of_replicates(std::string_view command) {
  return {.one_noise = fmt::format(
              "{} needs one noise for all times and replicates; leave it out (imunoise fit, "
              "diagnose and study take it)",
              command)};
}

Result<void> add_candidate(std::string_view text, Hertz rate, std::string_view command,
                           std::vector<FullModel>& to) {
  auto model = parse_full_model(text, rate, grammar_of_replicates(command));
  if (model && !model->effects.empty()) model = as_fitted(std::move(*model));
  if (!model) return tl::unexpected(model.error());
  for (const FullModel& before : to) {
    if (!same_effects(before, *model))
      return fail(fmt::format(
          "model: {} and {} have different effects, and a choice is between the noise of models "
          "with the same effects; imunoise study says whether an effect helps",
          print(before), print(*model)));
    if (same_noise(before.noise, model->noise))
      return fail(fmt::format("model: {} and {} are the same; name each model once", print(before),
                              print(*model)));
  }
  to.push_back(std::move(*model));
  return {};
}

FullModel as_fitted(FullModel model) {
  for (EffectTerm& term : model.effects) term = shape_of(std::move(term));
  const auto is_ramp = [](const Term& term) {
    return std::holds_alternative<RateRamp>(term.process);
  };
  const EffectTerm ramp(effect_named("ramp"), "", {{"own", 1.0}});
  const bool known =
      std::find(model.effects.begin(), model.effects.end(), ramp) != model.effects.end();
  if (std::erase_if(model.noise.terms, is_ramp) > 0 && !known) model.effects.push_back(ramp);
  return model;
}

}  // namespace imunoise
