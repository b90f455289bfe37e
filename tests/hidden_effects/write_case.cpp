// hidden_effects: writes one case of the blind trial to files, for a person to try
//
//   hidden_effects list
//   hidden_effects FOLDER [EFFECT | nothing] [DELTA] [SEED] [--withhold]
//   imunoise diagnose FOLDER/*.h5 --channel gyro_x --auto
//
// FOLDER/truth.json says what was hidden. Without an effect the seed draws one: then nobody knows
// until the file is opened.

#include <charconv>
#include <cstdio>
#include <cstring>
#include <fstream>
#include <nlohmann/json.hpp>

#include "recording/export/write_samples.h"
#include "tests/hidden_effects/generator/draw.h"
#include "tests/hidden_effects/generator/hidden_case.h"

namespace imunoise::hidden {
namespace {

int fail_with(const std::string& message) {
  std::fprintf(stderr, "hidden_effects: %s\n", message.c_str());
  return 1;
}

void list() {
  for (const HiddenEffect& effect : hidden_effects()) {
    static constexpr const char* kKinds[] = {"", "defect of the samples", "not in the catalogue",
                                             "outside the catalogue's exact shapes", "no defect"};
    std::printf("%-32s %s\n", effect.name().c_str(), kKinds[static_cast<int>(effect.kind)]);
  }
}

nlohmann::json truth(const HiddenCase& made) {
  nlohmann::json effects = nlohmann::json::array();
  for (std::size_t i = 0; i < made.injections.size(); ++i) {
    nlohmann::json parameters = nlohmann::json::array();
    for (const TrueParameter& one : made.injections[i].parameters) {
      parameters.push_back({{"name", one.name}, {"value", one.value}, {"unit", one.unit}});
    }
    effects.push_back({{"effect", made.spec.effects[i]},
                       {"delta", made.injections[i].delta},
                       {"delta_if_levels_were_known", made.injections[i].informed},
                       {"parameters", parameters}});
  }
  return {{"effects", effects},       {"seed", made.spec.seed}, {"withheld", made.spec.withhold},
          {"model", made.base.model}, {"channel", kSubject},    {"rate_hz", made.rate_hz}};
}

Result<void> write(const HiddenCase& made, const std::filesystem::path& folder) {
  std::filesystem::create_directories(folder);
  for (std::size_t r = 0; r < made.recordings.size(); ++r) {
    std::vector<recording::OutputChannel> channels;
    for (const Trace& trace : made.recordings[r].traces) {
      channels.push_back({trace.name, trace.values, parse_unit(trace.unit).value()});
    }
    const auto path = folder / ("replicate" + std::to_string(r + 1) + ".h5");
    if (auto done = recording::write_samples(path, channels, Hertz{made.rate_hz}); !done) {
      return done;
    }
  }
  std::ofstream(folder / "truth.json") << truth(made).dump(2) << "\n";
  return {};
}

// One of the catalogue's, by seed.
std::string drawn(std::uint64_t seed) {
  RandomStream random(seed);
  const HiddenEffect* effect = nullptr;
  do {
    effect = &hidden_effects()[below(random, hidden_effects().size())];
  } while (effect->kind != Kind::kCatalogue && effect->kind != Kind::kIntegrity);
  return effect->name();
}

template <class Number>
bool parse(const std::string& text, Number& value) {
  const char* const end = text.data() + text.size();
  const auto [stop, code] = std::from_chars(text.data(), end, value);
  return code == std::errc() && stop == end;
}

int run(std::vector<std::string> arguments) {
  CaseSpec spec;
  spec.withhold = std::erase(arguments, "--withhold") > 0;
  if (arguments.size() == 1 && arguments[0] == "list") {
    list();
    return 0;
  }
  if (arguments.empty() || arguments.size() > 4) {
    return fail_with("usage: hidden_effects FOLDER [EFFECT | nothing] [DELTA] [SEED] [--withhold]");
  }
  arguments.resize(4);
  spec.delta = 12.0;
  if (!arguments[2].empty() && !(parse(arguments[2], spec.delta) && spec.delta > 0.0)) {
    return fail_with("'" + arguments[2] + "' is no strength; give a positive number");
  }
  if (!arguments[3].empty() && !parse(arguments[3], spec.seed)) {
    return fail_with("'" + arguments[3] + "' is no seed; give a whole number");
  }
  const std::string name = arguments[1].empty() ? drawn(spec.seed) : arguments[1];
  if (name != "nothing") spec.effects = {name};
  if (name != "nothing" && find_effect(name) == nullptr) {
    return fail_with("no effect '" + name + "'; `hidden_effects list` names them");
  }
  const auto done = write(make_case(spec), arguments[0]);
  return done ? 0 : fail_with(done.error().message);
}

}  // namespace
}  // namespace imunoise::hidden

int main(int argc, char** argv) {
  return imunoise::hidden::run(std::vector<std::string>(argv + 1, argv + argc));
}
