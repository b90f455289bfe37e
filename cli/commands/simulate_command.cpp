#include <fmt/format.h>

#include "cli/commands/commands.h"
#include "cli/output.h"
#include "cli/progress_line.h"
#include "cli/simulated_witness.h"
#include "core/effects/parse_full_model.h"
#include "core/support/counted.h"
#include "recording/export/write_samples.h"
#include "study/report/json.h"

namespace imunoise::cli {
namespace {

std::filesystem::path replicate_path(const SimulateArguments& arguments, std::uint32_t replicate) {
  if (arguments.replicates == 1) return arguments.out;
  std::filesystem::path out = arguments.out;
  return out.replace_filename(
      fmt::format("{}_{}{}", out.stem().string(), replicate + 1, out.extension().string()));
}

// In the unit that it is written in; simulated values are counted from its zero.
void to_unit(std::vector<double>& values, const Unit& unit) {
  for (double& x : values) x /= unit.to_si;
}

// Draws one replicate and writes it, with its witnesses beside it.
Result<std::filesystem::path> write_replicate(const Simulation& simulation, std::uint32_t k,
                                              const SimulateArguments& arguments,
                                              const std::vector<WrittenWitness>& witnesses,
                                              const std::string& model) {
  SimulatedSamples drawn = simulation.replicate(k);
  to_unit(drawn.channel, arguments.unit);
  std::vector<recording::OutputChannel> channels{
      {arguments.channel, drawn.channel, arguments.unit}};
  for (std::size_t w = 0; w < witnesses.size(); ++w) {
    to_unit(drawn.witnesses[w], witnesses[w].unit);
    channels.push_back({witnesses[w].witness.name, drawn.witnesses[w], witnesses[w].unit});
  }
  std::filesystem::path path = replicate_path(arguments, k);
  auto done = recording::write_samples(path, channels, arguments.rate,
                                       {{"source", "imunoise simulate"},
                                        {"model", model},
                                        {"seed", std::to_string(arguments.seed)},
                                        {"replicate", std::to_string(k + 1)}});
  if (!done) return tl::unexpected(done.error());
  return path;
}

// What a simulation is made of.
struct Made {
  std::string model;
  Simulation simulation;
  std::vector<WrittenWitness> witnesses;
};

Result<Made> made_from(const SimulateArguments& arguments) {
  auto model = parse_full_model(arguments.model, arguments.rate);
  if (!model) return tl::unexpected(model.error());
  auto witnesses = witnesses_of(arguments);
  if (!witnesses) return tl::unexpected(witnesses.error());
  std::vector<SimulatedWitness> followed;
  for (const WrittenWitness& one : *witnesses) followed.push_back(one.witness);
  const std::string text = print(*model);
  auto simulation =
      Simulation::make(std::move(*model), {arguments.samples, arguments.rate, arguments.replicates},
                       arguments.seed, std::move(followed));
  if (!simulation) return tl::unexpected(simulation.error());
  return Made{text, std::move(*simulation), std::move(*witnesses)};
}

Result<void> write_replicates(const Made& made, const SimulateArguments& arguments,
                              v1::SimulationReport& report) {
  ProgressLine line("simulating");
  const Progress progress = line.progress();
  for (std::uint32_t k = 0; k < arguments.replicates; ++k) {
    const auto path = write_replicate(made.simulation, k, arguments, made.witnesses, made.model);
    if (!path) return tl::unexpected(path.error());
    report.add_files(path->string());
    progress.report(static_cast<double>(k + 1) / arguments.replicates);
  }
  return {};
}

}  // namespace

int run(const SimulateArguments& arguments) {
  const auto made = made_from(arguments);
  if (!made) return print_error(made.error());
  v1::SimulationReport report;
  report.set_model(made->model);
  report.set_rate_hz(arguments.rate.value);
  report.set_samples(static_cast<std::uint32_t>(arguments.samples));
  report.set_seed(arguments.seed);
  report.set_unit(arguments.unit.symbol);
  if (auto done = write_replicates(*made, arguments, report); !done)
    return print_error(done.error());
  if (arguments.json) {
    print(report::to_json(report));
    return 0;
  }
  print(fmt::format("{}\n{} at {:g} Hz, seed {}\n", report.model(),
                    counted(arguments.samples, "sample"), arguments.rate.value, arguments.seed));
  for (const std::string& file : report.files()) print("wrote " + file + "\n");
  return 0;
}

}  // namespace imunoise::cli
