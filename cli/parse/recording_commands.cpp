#include <memory>

#include "cli/parse/commands.h"
#include "cli/parse/input_options.h"

namespace imunoise::cli {
namespace {

constexpr const char* kSimulateExamples = R"help(
Examples:
  imunoise simulate --model "WN(sigma2=1e-6) + AR1(sigma2=1e-12, phi=0.999)" \
      --rate 100 --samples 1000000 --replicates 6 --seed 42 --unit rad/s --out run.h5
  writes run_1.h5 .. run_6.h5 (also .csv and .npy). The same seed gives the same numbers.)help";

constexpr const char* kVerifyExamples = R"help(
Examples:
  imunoise verify recordings/monday                      every chunk, gap and count of a recording
  imunoise verify recordings/monday --repair             after a crash or a failing disk
  imunoise verify recordings/monday/replicate-1/imu0/000012.h5 --json

Repairing loses nothing: what the journal holds becomes a chunk, damaged files are renamed to .broken, a
lost manifest is made from the chunks. The exit status is 0 when the recording is sound.)help";

ParsedCommand simulate_command(CLI::App& program) {
  struct Raw {
    SimulateArguments arguments;
    double rate = 0.0;
    std::string unit = "1";
    std::string out;
  };
  CLI::App* const simulate =
      program.add_subcommand("simulate", "Write recordings of a known model");
  simulate->footer(kSimulateExamples);
  const auto raw = std::make_shared<Raw>();
  SimulateArguments& simulation = raw->arguments;
  simulate->add_option("--model", simulation.model, "The model, with all its values")->required();
  simulate->add_option("--rate", raw->rate, "Sampling rate in Hz")
      ->required()
      ->check(CLI::PositiveNumber);
  simulate->add_option("--samples", simulation.samples, "Samples of each replicate")
      ->required()
      ->check(CLI::Range(std::size_t{16}, std::size_t{1} << 32U));
  simulate->add_option("--replicates", simulation.replicates, "Number of replicates")
      ->check(CLI::Range(1, 100000))
      ->capture_default_str();
  simulate->add_option("--seed", simulation.seed, "Seed of the random numbers")
      ->capture_default_str();
  simulate->add_option("--unit", raw->unit, "Unit in which the values are written, e.g. deg/s")
      ->capture_default_str();
  simulate->add_option("--channel", simulation.channel, "Name of the channel")
      ->capture_default_str();
  simulate
      ->add_option("--out", raw->out, "File to write (.h5, .csv, .npy); replicates get _1, _2, ..")
      ->required();
  simulate->add_flag("--json", simulation.json, "Print the result as JSON");
  return {simulate, [raw] {
            SimulateArguments out = raw->arguments;
            out.rate = Hertz{raw->rate};
            out.unit = unit_from(raw->unit);
            out.out = raw->out;
            return out;
          }};
}

ParsedCommand verify_command(CLI::App& program) {
  CLI::App* const verify = program.add_subcommand("verify", "Check a recording, and repair it");
  verify->footer(kVerifyExamples);
  const auto arguments = std::make_shared<VerifyArguments>();
  const auto path = std::make_shared<std::string>();
  verify->add_option("FOLDER", *path, "A recording's folder, or one chunk file of it")
      ->required()
      ->check(CLI::ExistingPath);
  verify->add_flag("--repair", arguments->repair, "Repair what can be repaired");
  verify->add_flag("--json", arguments->json, "Print the result as JSON");
  return {verify, [arguments, path] {
            VerifyArguments out = *arguments;
            out.path = *path;
            if (out.repair && !std::filesystem::is_directory(out.path)) {
              refuse("--repair",
                     "one chunk by itself cannot be repaired; name the recording's folder");
            }
            return out;
          }};
}

}  // namespace

std::vector<ParsedCommand> recording_commands(CLI::App& program) {
  return {simulate_command(program), verify_command(program)};
}

}  // namespace imunoise::cli
