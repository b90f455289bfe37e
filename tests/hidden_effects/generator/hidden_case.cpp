#include "tests/hidden_effects/generator/hidden_case.h"

#include <iterator>

namespace imunoise::hidden {
namespace {

// Distinct streams for distinct cases of one seed.
std::uint32_t key(const std::string& text) {
  std::uint32_t out = 2166136261U;  // FNV-1a
  for (const char c : text) out = (out ^ static_cast<unsigned char>(c)) * 16777619U;
  return out;
}

void withhold(std::vector<Recording>& recordings, const std::string& witness) {
  for (Recording& recording : recordings) {
    std::erase_if(recording.traces, [&](const Trace& trace) { return trace.name == witness; });
  }
}

}  // namespace

const std::vector<HiddenEffect>& hidden_effects() {
  static const std::vector<HiddenEffect> kEffects = [] {
    std::vector<HiddenEffect> out;
    for (const auto& part :
         {noise_effects(), periodic_effects(), slow_effects(), witness_effects(),
          neighbour_effects(), irregular_effects(), integrity_effects(), outside_effects(),
          foreign_powers(), foreign_waves(), foreign_courses(), foreign_spectra(),
          foreign_couplings(), foreign_samples()}) {
      out.insert(out.end(), part.begin(), part.end());
    }
    return out;
  }();
  return kEffects;
}

HiddenEffect foreign(std::string id, std::string variant,
                     Injection (*hide)(Scene& scene, double delta)) {
  HiddenEffect out;
  out.id = std::move(id);
  out.variant = std::move(variant);
  out.kind = Kind::kForeign;
  out.hide = hide;
  return out;
}

const HiddenEffect* find_effect(std::string_view name) {
  for (const HiddenEffect& effect : hidden_effects()) {
    if (effect.name() == name) return &effect;
  }
  return nullptr;
}

HiddenCase make_case(const CaseSpec& spec) {
  HiddenCase out;
  out.spec = spec;
  Base base = spec.null_base;
  Weather weather = spec.null_weather;
  std::string names;
  for (const std::string& name : spec.effects) {
    if (names.empty()) {
      base = find_effect(name)->base;
      out.rate_hz = find_effect(name)->rate_hz;
      weather = Weather::kLively;
    }
    names += name + ";";
  }
  Scene scene = draw_scene(base, weather, spec.replicates, spec.samples, out.rate_hz,
                           RandomStream(spec.seed, {key(names), static_cast<std::uint32_t>(base),
                                                    static_cast<std::uint32_t>(weather)}));
  out.base = scene.base;
  out.clean = scene.recordings;
  for (const std::string& name : spec.effects) {
    out.injections.push_back(find_effect(name)->hide(scene, spec.delta));
  }
  out.recordings = std::move(scene.recordings);
  if (spec.withhold) {
    for (const std::string& name : spec.effects) {
      withhold(out.recordings, find_effect(name)->witness);
      withhold(out.clean, find_effect(name)->witness);
    }
  }
  return out;
}

const char* name_of(Base base) {
  static constexpr const char* kNames[] = {"WN", "WN+RW", "AR1+RW", "WN+AR1+RW", "WN+FN+RW"};
  return kNames[static_cast<int>(base)];
}

const char* name_of(Weather weather) {
  static constexpr const char* kNames[] = {"calm", "lively", "slow"};
  return kNames[static_cast<int>(weather)];
}

std::string describe(const CaseSpec& spec) {
  std::string out;
  for (const std::string& name : spec.effects) out += (out.empty() ? "" : " + ") + name;
  if (spec.effects.empty()) {
    out = std::string("nothing in ") + name_of(spec.null_base) + ", " + name_of(spec.null_weather) +
          " weather";
  } else {
    out += ", δ = " + std::to_string(static_cast<int>(spec.delta));
  }
  if (spec.withhold) out += ", witness withheld";
  return out + ", seed " + std::to_string(spec.seed);
}

}  // namespace imunoise::hidden
