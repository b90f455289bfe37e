#include <fmt/format.h>

#include "cli/commands/commands.h"
#include "cli/output.h"
#include "cli/progress_line.h"
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

}  // namespace

int run(const SimulateArguments& arguments) {
  const Result<Model> model = parse_model(arguments.model, arguments.rate);
  if (!model) return print_error(model.error());
  if (!complete(*model)) {
    return print_error({fmt::format(
        "model: {} leaves values open; give each, as in WN(sigma2=1e-6)", print(*model))});
  }
  v1::SimulationReport report;
  report.set_model(print(*model));
  report.set_rate_hz(arguments.rate.value);
  report.set_samples(static_cast<std::uint32_t>(arguments.samples));
  report.set_seed(arguments.seed);
  report.set_unit(arguments.unit.symbol);
  ProgressLine line("simulating");
  const Progress progress = line.progress();
  for (std::uint32_t k = 0; k < arguments.replicates; ++k) {
    std::vector<double> values = simulate(*model, arguments.samples, arguments.seed, k);
    for (double& x : values) x /= arguments.unit.to_si;
    const std::filesystem::path path = replicate_path(arguments, k);
    const recording::OutputChannel channel{arguments.channel, values, arguments.unit};
    const auto done = recording::write_samples(path, std::span(&channel, 1), arguments.rate,
                                               {{"source", "imunoise simulate"},
                                                {"model", report.model()},
                                                {"seed", std::to_string(arguments.seed)},
                                                {"replicate", std::to_string(k + 1)}});
    if (!done) return print_error(done.error());
    report.add_files(path.string());
    progress.report(static_cast<double>(k + 1) / arguments.replicates);
  }
  if (arguments.json) {
    print(report::to_json(report));
    return 0;
  }
  print(fmt::format("{}\n{} samples at {:g} Hz, seed {}\n", report.model(), arguments.samples,
                    arguments.rate.value, arguments.seed));
  for (const std::string& file : report.files()) print("wrote " + file + "\n");
  return 0;
}

}  // namespace imunoise::cli
