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

constexpr const char* kRecordExamples = R"help(
Examples:
  imunoise record recordings/monday --device "adis16405 rate=102.4" --duration 3600 --replicates 6
  imunoise record recordings/monday --device "xsens port=/dev/ttyUSB0" --device "can interface=can0 preset=mti600" \
      --duration 600
  imunoise record copy --device "replay file=run1.h5 speed=0"
  imunoise record trial --device "emulated device=adis16405 seed=7" --duration 10
  imunoise record monday --wire --device "xsens port=/dev/ttyUSB0" --duration 60

A device is a driver and its options (imunoise drivers lists them), in quotes. Ctrl-C ends a recording in good
order: what was recorded is kept. Without --duration it lasts until then, or until every device has ended.)help";

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
  simulate->add_option("--rate", raw->rate, "Sampling rate in Hz")->required()->check(above_zero());
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

// "driver name=value 'name=value with blanks'".
DeviceArguments device_from(const std::string& text) {
  std::vector<std::string> words;
  for (std::string& word : CLI::detail::split_up(text)) {
    if (!word.empty()) words.push_back(std::move(word));
  }
  if (words.empty()) refuse("--device", "name a driver, and behind it its options");
  DeviceArguments out{words.front(), {}};
  out.options.assign(words.begin() + 1, words.end());
  return out;
}

ParsedCommand record_command(CLI::App& program) {
  struct Raw {
    RecordArguments arguments;
    std::string folder;
    std::vector<std::string> devices;
    std::vector<std::string> driver_folders;
    double duration = 0.0;
    std::uint32_t replicate = 0;
  };
  CLI::App* const record = program.add_subcommand("record", "Record devices");
  record->footer(kRecordExamples);
  const auto raw = std::make_shared<Raw>();
  record->add_option("FOLDER", raw->folder, "The recording's folder; made when missing")
      ->required();
  record->add_option("--device", raw->devices, "A driver and its options; repeatable")
      ->required()
      ->allow_extra_args(false)
      ->type_name("\"DRIVER NAME=VALUE ..\"");
  record->add_option("--duration", raw->duration, "Of each replicate, in s")->check(above_zero());
  record->add_option("--replicates", raw->arguments.replicates, "How many, one after another")
      ->check(CLI::Range(1, 100000))
      ->capture_default_str();
  record->add_option("--replicate", raw->replicate, "Number of the first (default: the next free)")
      ->check(CLI::Range(1, 1000000));
  record
      ->add_option("--driver-path", raw->driver_folders,
                   "A folder to search for drivers before the others; repeatable")
      ->check(CLI::ExistingDirectory);
  record->add_flag("--wire", raw->arguments.wire,
                   "Keep the bytes of each device too, in replicate-1/DEVICE.wire");
  record->add_flag("--json", raw->arguments.json, "Print the result as JSON");
  return {record, [raw] {
            RecordArguments out = raw->arguments;
            out.folder = raw->folder;
            for (const std::string& text : raw->devices) out.devices.push_back(device_from(text));
            out.driver_folders.assign(raw->driver_folders.begin(), raw->driver_folders.end());
            if (raw->duration > 0.0) out.duration = std::chrono::duration<double>(raw->duration);
            if (raw->replicate > 0) out.replicate = raw->replicate;
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
  return {simulate_command(program), record_command(program), verify_command(program)};
}

}  // namespace imunoise::cli
