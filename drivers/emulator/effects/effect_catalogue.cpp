#include "drivers/emulator/effects/effect_catalogue.h"

#include <fmt/format.h>

#include <algorithm>

#include "drivers/emulator/effects/call_text.h"
#include "drivers/emulator/effects/disturbances.h"
#include "drivers/emulator/effects/limits.h"
#include "drivers/emulator/effects/surroundings.h"

namespace imunoise::emulator {
namespace {

constexpr double kHour = 3600.0;
constexpr std::uint32_t kEffectStreams = 1000;  // beyond those of noise: see ModelledSource

// An effect that was asked for.
struct Wanted {
  const std::vector<double>& numbers;  // as the parameters of its entry
  const std::vector<QuantityIndex>& quantities;
  const Measurement& at_rest;
  std::uint64_t seed;
  std::uint32_t index;

  RandomStream random(QuantityIndex quantity) const {
    return RandomStream(seed, {kEffectStreams + index, static_cast<std::uint32_t>(quantity)});
  }
};

// Adds one Made to `to` for each quantity, of what arguments_of(quantity) returns as a tuple.
template <class Made, class Arguments>
void add_each(const Wanted& wanted, std::vector<std::unique_ptr<Effect>>& to,
              Arguments&& arguments_of) {
  for (const QuantityIndex quantity : wanted.quantities) {
    std::apply(
        [&](auto&&... arguments) {
          to.push_back(
              std::make_unique<Made>(quantity, std::forward<decltype(arguments)>(arguments)...));
        },
        arguments_of(quantity));
  }
}

void add_witness(QuantityIndex witness, const Wanted& wanted, Effects& to) {
  const auto& n = wanted.numbers;
  to.surroundings.push_back(std::make_unique<Movement>(
      witness, Movement::Shape{.swing = n[0], .period = n[1], .drift = n[2] / kHour}));
  if (n[3] == 0.0 && n[4] == 0.0) return;
  const Coupling::Strength strength{.coefficient = n[3], .quadratic = n[4], .lag = n[5]};
  add_each<Coupling>(wanted, to.disturbances, [&](QuantityIndex) {
    return std::tuple(witness, at(wanted.at_rest, witness), strength);
  });
}

void add_hum(const Wanted& wanted, Effects& to) {
  const auto& n = wanted.numbers;
  const Hum::Shape shape{n[0], n[1], static_cast<int>(n[2]), n[3]};
  add_each<Hum>(wanted, to.disturbances, [&](QuantityIndex) { return std::tuple(shape); });
}

struct Entry {
  std::string_view name;
  std::string_view meaning;
  std::vector<NumberParameter> parameters;
  void (*add)(const Wanted&, Effects&);
};

constexpr double kAny = 1e18;

std::vector<NumberParameter> witness_parameters(std::string_view unit, std::string_view drift) {
  return {{"swing", unit, 0.0, -kAny},  {"period", "s", kHour, 1e-6},  {"drift", drift, 0.0, -kAny},
          {"coupling", "", 0.0, -kAny}, {"quadratic", "", 0.0, -kAny}, {"lag", "s", 0.0}};
}

std::vector<NumberParameter> hum_parameters(std::optional<double> frequency, double harmonics) {
  return {{"frequency", "Hz", frequency},
          {"amplitude", "", std::nullopt, -kAny},
          {"harmonics", "", harmonics, 1.0, 100.0},
          {"phase", "rad", 0.0, -kAny}};
}

const std::vector<Entry>& catalogue() {
  static const std::vector<Entry> kEntries = {
      {"temperature",
       "temperature swings and drifts; the channel follows (per K, per K²) with a lag",
       witness_parameters("K", "K/h"),
       [](const Wanted& w, Effects& to) { add_witness(kTemperature, w, to); }},
      {"supply", "the same with the supply voltage (per V, per V²)", witness_parameters("V", "V/h"),
       [](const Wanted& w, Effects& to) { add_witness(kSupply, w, to); }},
      {"fan", "a line and its harmonics, the k-th of amplitude / k",
       hum_parameters(std::nullopt, 3.0), add_hum},
      {"mains", "lines of the mains, aliased by sampling", hum_parameters(50.0, 1.0), add_hum},
      {"step",
       "a step of the bias",
       {{"at", "s"}, {"height", "", std::nullopt, -kAny}},
       [](const Wanted& w, Effects& to) {
         add_each<Step>(w, to.disturbances,
                        [&](QuantityIndex) { return std::tuple(w.numbers[0], w.numbers[1]); });
       }},
      {"telegraph",
       "two levels, `height` apart, each held for `dwell` on average",
       {{"height", "", std::nullopt, -kAny}, {"dwell", "s", std::nullopt, 1e-6}},
       [](const Wanted& w, Effects& to) {
         add_each<Telegraph>(w, to.disturbances, [&](QuantityIndex quantity) {
           return std::tuple(w.numbers[0], w.numbers[1], w.random(quantity));
         });
       }},
      {"outliers",
       "a share of the samples has an added normal random value",
       {{"share", "", std::nullopt, 0.0, 1.0}, {"deviation", ""}},
       [](const Wanted& w, Effects& to) {
         add_each<Outliers>(w, to.disturbances, [&](QuantityIndex quantity) {
           return std::tuple(w.numbers[0], w.numbers[1], w.random(quantity));
         });
       }},
      {"warm_up",
       "a bias that decays after power-on",
       {{"size", "", std::nullopt, -kAny}, {"time", "s", std::nullopt, 1e-6}},
       [](const Wanted& w, Effects& to) {
         add_each<WarmUp>(w, to.disturbances,
                          [&](QuantityIndex) { return std::tuple(w.numbers[0], w.numbers[1]); });
       }},
      {"saturation",
       "values limited to ± limit",
       {{"limit", ""}},
       [](const Wanted& w, Effects& to) {
         add_each<Saturation>(w, to.limits,
                              [&](QuantityIndex) { return std::tuple(w.numbers[0]); });
       }},
      {"stuck",
       "the same value for a while",
       {{"at", "s"}, {"for", "s"}},
       [](const Wanted& w, Effects& to) {
         add_each<Stuck>(w, to.limits,
                         [&](QuantityIndex) { return std::tuple(w.numbers[0], w.numbers[1]); });
       }},
  };
  return kEntries;
}

std::string names() {
  std::string out;
  for (const Entry& entry : catalogue()) out += (out.empty() ? "" : ", ") + std::string(entry.name);
  return out;
}

}  // namespace

Result<void> add_effect(std::string_view text, const Measurement& at_rest, std::uint64_t seed,
                        std::uint32_t index, Effects& effects) {
  auto call = parse_call(text);
  if (!call) return tl::make_unexpected(call.error());
  const auto& entries = catalogue();
  const auto entry = std::find_if(entries.begin(), entries.end(),
                                  [&](const Entry& e) { return e.name == call->name; });
  if (entry == entries.end()) {
    return fail(fmt::format("no effect '{}'; there are {}", call->name, names()));
  }
  auto& arguments = call->arguments;
  const auto channel = std::find_if(arguments.begin(), arguments.end(),
                                    [](const auto& one) { return one.first == "channel"; });
  const auto quantities = quantities_of(channel == arguments.end() ? "gyro" : channel->second);
  if (!quantities) return fail(call->name + ": " + quantities.error().message);
  if (channel != arguments.end()) arguments.erase(channel);
  const auto numbers = numbers_of(*call, entry->parameters);
  if (!numbers) return tl::make_unexpected(numbers.error());
  entry->add({*numbers, *quantities, at_rest, seed, index}, effects);
  return {};
}

std::vector<std::string> describe_effects() {
  std::vector<std::string> out;
  for (const Entry& entry : catalogue()) {
    out.push_back(fmt::format("{}: {}", usage(entry.name, entry.parameters), entry.meaning));
  }
  return out;
}

}  // namespace imunoise::emulator
