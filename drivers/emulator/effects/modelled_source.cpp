#include "drivers/emulator/effects/modelled_source.h"

#include <fmt/format.h>

#include <algorithm>

#include "core/model/grammar.h"
#include "core/model/syntax.h"

namespace imunoise::emulator {
namespace {

constexpr double kStandardGravity = 9.80665;

// Of a consumer's MEMS sensor at 100 Hz or so.
const std::vector<std::string>& default_models() {
  static const std::vector<std::string> kModels = {
      "gyro: WN(sigma2=2.5e-5) + RW(gamma2=1e-13)", "acc: WN(sigma2=4e-4) + RW(gamma2=1e-11)",
      "mag: WN(sigma2=4e-14)", "temperature: WN(sigma2=1e-2)"};
  return kModels;
}

// For a model with a term that is no noise: where effects go.
std::string effects_are_apart(std::string_view model) {
  const auto terms = split_model(model);
  const bool only_noise =
      !terms || std::all_of(terms->begin(), terms->end(), [](const WrittenTerm& one) {
        return one.name.empty() || is_process(one.name);
      });
  if (only_noise) return "";
  return "; the model of an emulated device holds noise only, because effects act on several of "
         "its "
         "quantities: give each apart, such as --effect \"fan(frequency=23, amplitude=1e-3)\" "
         "(imunoise emulate --help lists them)";
}

void apply(const std::vector<std::unique_ptr<Effect>>& effects, const Moment& moment,
           Measurement& measurement) {
  for (const auto& effect : effects) effect->apply(moment, measurement);
}

}  // namespace

Measurement at_rest() {
  Measurement out;
  out.specific_force = {0.0, 0.0, kStandardGravity};
  out.field = {22.5e-6, 0.0, -39e-6};
  out.temperature = 298.15;
  out.supply = 5.0;
  return out;
}

Result<std::unique_ptr<ModelledSource>> ModelledSource::make(const SourceTexts& texts) {
  auto out = std::unique_ptr<ModelledSource>(new ModelledSource);
  for (const std::string& text : texts.models.empty() ? default_models() : texts.models) {
    if (auto done = out->add_model(text, texts); !done) return tl::make_unexpected(done.error());
  }
  const Measurement rest = at_rest();
  for (std::uint32_t i = 0; i < texts.effects.size(); ++i) {
    auto done = add_effect(texts.effects[i], rest, texts.seed, i, out->effects_);
    if (!done) return tl::make_unexpected(done.error());
  }
  return out;
}

Result<void> ModelledSource::add_model(std::string_view text, const SourceTexts& texts) {
  const std::size_t colon = text.find(':');
  const bool named = colon != std::string_view::npos;
  std::string_view name = named ? text.substr(0, colon) : "gyro";
  while (!name.empty() && name.back() == ' ') name.remove_suffix(1);
  while (!name.empty() && name.front() == ' ') name.remove_prefix(1);
  const auto quantities = quantities_of(name);
  if (!quantities) return tl::make_unexpected(quantities.error());
  const std::string_view noise = named ? text.substr(colon + 1) : text;
  const auto model = parse_model(noise, texts.rate);
  if (!model) return fail(model.error().message + effects_are_apart(noise));
  if (!complete(*model)) {
    return fail(fmt::format("model: {} leaves values open; give each, as in WN(sigma2=1e-6)",
                            print(*model)));
  }
  for (const QuantityIndex quantity : *quantities) {
    noise_[quantity].emplace(*model, texts.seed, static_cast<std::uint32_t>(quantity));
  }
  return {};
}

Moment ModelledSource::moment_of(double time) {
  Moment out{time, before_power_failed_ + time, 0.0};
  if (last_) {
    if (time < *last_) out.elapsed = (before_power_failed_ += *last_) + time;
    out.step = time < *last_ ? time : time - *last_;
  }
  last_ = time;
  return out;
}

Measurement ModelledSource::measure(double time) {
  const Moment moment = moment_of(time);
  Measurement out = at_rest();
  apply(effects_.surroundings, moment, out);
  apply(effects_.disturbances, moment, out);
  for (QuantityIndex i = 0; i < noise_.size(); ++i) {
    if (noise_[i]) at(out, i) += noise_[i]->next();
  }
  apply(effects_.limits, moment, out);
  return out;
}

}  // namespace imunoise::emulator
