#include <algorithm>
#include <memory>

#include "cli/parse/commands.h"
#include "cli/parse/input_options.h"

namespace imunoise::cli {
namespace {

constexpr const char* kSimulateExamples = R"help(
Examples:
  imunoise simulate --model "WN(sigma2=1e-6) + AR1(sigma2=1e-12, phi=0.999)" \
      --rate 100 --samples 1000000 --replicates 6 --seed 42 --unit rad/s --out run.h5
  imunoise simulate --model "WN(sigma2=1e-6) + line(f=23.4, amplitude=1e-3)" \
      --rate 100 --samples 100000 --out fan.h5
  imunoise simulate --model "WN(sigma2=1e-6) + witness(temperature, lag=300, coefficient=1e-5)" \
      --witness "temperature[K]: RW(gamma2=1e-6)" --rate 100 --samples 360000 --out warm.h5
  imunoise simulate --model "WN(sigma2=1e-6) + witness(temperature, coefficient=1e-5)" \
      --witness temperature=run1.h5 --rate 100 --samples 360000 --out follows.h5

The first example writes run_1.h5 to run_6.h5. The same seed gives the same numbers.
Give every value of the model, the sizes of effects included; docs/models.md lists them.)help";

// "NAME[UNIT]: MODEL" or "NAME=FILE".
WitnessArguments witness_from(const std::string& text) {
  const std::size_t sign = text.find_first_of(":=");
  if (sign == std::string::npos || sign == 0 || sign + 1 == text.size())
    refuse("--witness", "expected \"temperature[K]: RW(gamma2=1e-6)\" or temperature=run1.h5");
  WitnessArguments out;
  out.name = CLI::detail::trim_copy(text.substr(0, sign));
  if (text[sign] == '=') {
    out.files.emplace_back(text.substr(sign + 1));
    return out;
  }
  out.unit = unit_from("1");
  if (const std::size_t unit = out.name.find('['); unit != std::string::npos) {
    if (!out.name.ends_with(']')) refuse("--witness", "expected ']' behind the unit of " + text);
    out.unit = unit_from(out.name.substr(unit + 1, out.name.size() - unit - 2));
    out.name = CLI::detail::trim_copy(out.name.substr(0, unit));
  }
  out.model = text.substr(sign + 1);
  return out;
}

// A channel each; a file more of one is for its next replicate.
std::vector<WitnessArguments> witnesses_from(const std::vector<std::string>& texts) {
  std::vector<WitnessArguments> out;
  for (const std::string& text : texts) {
    WitnessArguments one = witness_from(text);
    const auto same = std::find_if(out.begin(), out.end(),
                                   [&](const auto& other) { return other.name == one.name; });
    if (same == out.end()) {
      out.push_back(std::move(one));
    } else if (same->files.empty() || one.files.empty()) {
      refuse("--witness", one.name + " is given twice");
    } else {
      same->files.push_back(one.files.front());
    }
  }
  return out;
}

constexpr const char* kRecordExamples = R"help(
Examples:
  imunoise record recordings/monday --device "adis16405 rate=102.4" --duration 3600 --replicates 6
  imunoise record recordings/monday --device "xsens port=/dev/ttyUSB0" --device "can interface=can0 preset=mti600" \
      --duration 600
  imunoise record copy --device "replay file=run1.h5 speed=0"
  imunoise record trial --device "emulated device=adis16405 seed=7" --duration 10
  imunoise record monday --wire --device "xsens port=/dev/ttyUSB0" --duration 60

Write each device as a driver and its options, in quotes; imunoise drivers lists them. Ctrl-C ends the
recording and keeps all samples. Without --duration, imunoise records until Ctrl-C or until all devices end.)help";

constexpr const char* kVerifyExamples = R"help(
Examples:
  imunoise verify recordings/monday                      check every chunk, gap and count
  imunoise verify recordings/monday --repair             after a crash or a failing disk
  imunoise verify recordings/monday/replicate-1/imu0/000012.h5 --json

--repair loses no data: it turns journals into chunks, renames damaged files to .broken and rebuilds a missing
manifest from the chunks. The exit status is 0 if the recording is intact.)help";

ParsedCommand simulate_command(CLI::App& program) {
  struct Raw {
    SimulateArguments arguments;
    double rate = 0.0;
    std::string unit = "1";
    std::string out;
    std::vector<std::string> witnesses;
  };
  CLI::App* const simulate =
      program.add_subcommand("simulate", "Simulate recordings of a known model");
  simulate->footer(kSimulateExamples);
  const auto raw = std::make_shared<Raw>();
  SimulateArguments& simulation = raw->arguments;
  simulate
      ->add_option("--model", simulation.model,
                   "Noise and effects to simulate, with all their values")
      ->type_name("MODEL")
      ->required();
  simulate
      ->add_option(
          "--witness", raw->witnesses,
          "Witness that effects follow, also written: noise in SI units (NAME[UNIT]: MODEL) or a "
          "recorded channel (NAME=FILE); repeatable, also for one file per replicate")
      ->allow_extra_args(false)
      ->type_name("WITNESS");
  simulate->add_option("--rate", raw->rate, "Sampling rate (Hz)")
      ->type_name("HZ")
      ->required()
      ->check(above_zero());
  simulate->add_option("--samples", simulation.samples, "Number of samples per replicate")
      ->type_name("COUNT")
      ->required()
      ->check(CLI::Range(std::size_t{16}, std::size_t{1} << 32U));
  simulate->add_option("--replicates", simulation.replicates, "Number of replicates")
      ->type_name("COUNT")
      ->check(CLI::Range(1, 100000))
      ->capture_default_str();
  simulate->add_option("--seed", simulation.seed, "Random seed")
      ->type_name("SEED")
      ->capture_default_str();
  simulate->add_option("--unit", raw->unit, "Unit of the values written, such as deg/s")
      ->type_name("UNIT")
      ->capture_default_str();
  simulate->add_option("--channel", simulation.channel, "Name of the channel")
      ->type_name("NAME")
      ->capture_default_str();
  simulate
      ->add_option("--out", raw->out,
                   "File to write (.h5, .csv or .npy); several replicates get _1, _2, ...")
      ->type_name("FILE")
      ->required();
  simulate->add_flag("--json", simulation.json, "Print the result as JSON");
  return {simulate, [raw] {
            SimulateArguments out = raw->arguments;
            out.rate = Hertz{raw->rate};
            out.unit = unit_from(raw->unit);
            out.out = raw->out;
            out.witnesses = witnesses_from(raw->witnesses);
            return out;
          }};
}

// Words between blanks; within '' or "", blanks are part of a word.
std::vector<std::string> words_of(const std::string& text) {
  std::vector<std::string> out;
  char quote = 0;
  bool inside = false;  // of a word
  for (const char c : text) {
    const bool blank = quote == 0 && (c == ' ' || c == '\t');
    if (!blank && !inside) out.emplace_back();
    inside = !blank;
    if (blank) continue;
    if (quote == 0 && (c == '\'' || c == '"')) {
      quote = c;
    } else if (c == quote) {
      quote = 0;
    } else {
      out.back() += c;
    }
  }
  if (quote != 0) refuse("--device", std::string("a quote is not closed: ") + quote);
  return out;
}

// "driver name=value name='value with blanks'".
DeviceArguments device_from(const std::string& text) {
  const std::vector<std::string> words = words_of(text);
  if (words.empty())
    refuse("--device", "expected a driver and its options, such as \"xsens port=/dev/ttyUSB0\"");
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
  CLI::App* const record = program.add_subcommand("record", "Record one or more devices");
  record->footer(kRecordExamples);
  const auto raw = std::make_shared<Raw>();
  record->add_option("FOLDER", raw->folder, "Folder of the recording; created if missing")
      ->required();
  record
      ->add_option("--device", raw->devices,
                   "Driver and its options, such as \"xsens port=/dev/ttyUSB0\"")
      ->required()
      ->allow_extra_args(false)
      ->type_name("DEVICE");
  record->add_option("--duration", raw->duration, "Length of each replicate (s)")
      ->type_name("SECONDS")
      ->default_str("until Ctrl-C")
      ->check(above_zero());
  record->add_option("--replicates", raw->arguments.replicates, "Number of replicates")
      ->type_name("COUNT")
      ->check(CLI::Range(1, 100000))
      ->capture_default_str();
  record->add_option("--replicate", raw->replicate, "Number of the first replicate")
      ->type_name("NUMBER")
      ->default_str("the next free one")
      ->check(CLI::Range(1, 1000000));
  record->add_option("--driver-path", raw->driver_folders, "Folder to search for drivers first")
      ->type_name("FOLDER")
      ->check(CLI::ExistingDirectory);
  record->add_flag("--wire", raw->arguments.wire,
                   "Keep the raw bytes of each device, too, in replicate-1/DEVICE.wire");
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
  CLI::App* const verify =
      program.add_subcommand("verify", "Check a recording, and optionally repair it");
  verify->footer(kVerifyExamples);
  const auto arguments = std::make_shared<VerifyArguments>();
  const auto path = std::make_shared<std::string>();
  verify->add_option("FOLDER", *path, "Folder of the recording, or one of its chunk files")
      ->required()
      ->check(CLI::ExistingPath);
  verify->add_flag("--repair", arguments->repair, "Repair the recording");
  verify->add_flag("--json", arguments->json, "Print the result as JSON");
  return {verify, [arguments, path] {
            VerifyArguments out = *arguments;
            out.path = *path;
            if (out.repair && !std::filesystem::is_directory(out.path)) {
              refuse("--repair", "needs the folder of the recording, not one chunk file");
            }
            return out;
          }};
}

}  // namespace

std::vector<ParsedCommand> recording_commands(CLI::App& program) {
  return {simulate_command(program), record_command(program), verify_command(program)};
}

}  // namespace imunoise::cli
