#include "cli/arguments.h"

#include <fmt/format.h>

#include <CLI/CLI.hpp>

namespace imunoise::cli {
namespace {

constexpr const char* kExamples = R"help(
Examples:
  imunoise fit run?.h5 --channel gyro_x                  a noise model from all replicates
  imunoise fit run?.h5 --model "2*AR1 + WN + RW" --report gyro.html --svg gyro.svg
  imunoise wv run1.csv --rate 100 --unit deg/s           the measured wavelet variance
  imunoise simulate --model "WN(sigma2=1e-6) + RW(gamma2=1e-14)" --rate 100 \
      --samples 360000 --replicates 6 --seed 1 --out run.h5
  imunoise verify recordings/monday                      is the recording intact?

imunoise COMMAND --help says more.)help";

constexpr const char* kFitExamples = R"help(
Examples:
  imunoise fit replicate?_gyro.h5 --channel gyro_x --model "2*AR1 + WN + RW"
  imunoise fit long.npy --split-into 6 --rate 200 --unit "m/s^2" --report acc.html
  imunoise fit run?.csv --model "WN + RES + RW" --weights diag --json > fit.json

Models are sums of: WN white noise, QN quantisation noise, RW random walk, DR drift, AR1 and GM Markov
noise, RES resonance, MA(q), MAVG(n) and BARTLETT(n) filters, FN flicker noise. A value in brackets
stays fixed: WN(sigma2=1e-6). Values are per sample in SI units; GM's tc is in seconds.)help";

constexpr const char* kWvExamples = R"help(
Examples:
  imunoise wv run1.h5                                    every channel, drawn and tabulated
  imunoise wv run?.csv --channel gyro_x --per-octave 4 --json > wv.json
  imunoise wv run1.h5 --robust 0.6                       unmoved by outliers)help";

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

// Texts that need a look-up after parsing.
struct Raw {
  std::vector<std::string> files;
  std::vector<std::string> channels;
  double rate = 0.0;
  std::string unit;
  std::string delimiter;
  bool header = false;
  bool no_header = false;
  std::size_t split_into = 1;
  int per_octave = 1;
  std::string robust;
  double confidence = 0.95;
};

void add_input(CLI::App& app, Raw& raw) {
  app.add_option(
         "FILES", raw.files,
         "Recordings, one replicate each: HDF5, CSV, .npy, raw numbers with a sidecar; or the "
         "folder of one recording")
      ->required()
      ->check(CLI::ExistingPath);
  app.add_option("--channel", raw.channels, "Channels to analyse, by name (default: all)")
      ->delimiter(',')
      ->allow_extra_args(false);  // what follows the name is a file again
  app.add_option("--rate", raw.rate, "Sampling rate in Hz, where the file does not say")
      ->check(CLI::PositiveNumber);
  app.add_option("--unit", raw.unit,
                 "Unit of the channels, e.g. deg/s; wins over what the file says");
  app.add_option("--delimiter", raw.delimiter,
                 "Separator of a text file, one character or 'tab' (default: detected)");
  auto* const header =
      app.add_flag("--header", raw.header, "The first row of a text file names its columns");
  app.add_flag("--no-header", raw.no_header, "The first row of a text file holds numbers")
      ->excludes(header);
  app.add_option("--split-into", raw.split_into, "Cut each file into K replicates of equal length")
      ->check(CLI::Range(1, 100000))
      ->type_name("K");
  app.add_option("--per-octave", raw.per_octave, "Scales an octave")
      ->check(CLI::IsMember({1, 2, 4}))
      ->capture_default_str();
  app.add_option("--robust", raw.robust, "Robust estimator, by its nominal efficiency")
      ->check(CLI::IsMember({"0.6", "0.8", "0.9"}));
  app.add_option("--confidence", raw.confidence, "Of the intervals")
      ->check(CLI::Range(0.5, 0.9999))
      ->capture_default_str();
}

[[noreturn]] void refuse(const std::string& option, const std::string& why) {
  throw CLI::ValidationError(option, why);
}

Unit unit_from(const std::string& text) {
  const Result<Unit> unit = parse_unit(text);
  if (!unit) refuse("--unit", unit.error().message);
  return *unit;
}

InputArguments input_from(const Raw& raw) {
  InputArguments out;
  out.files.assign(raw.files.begin(), raw.files.end());
  if (!(raw.channels.size() == 1 && raw.channels[0] == "all")) out.import.channels = raw.channels;
  if (raw.rate > 0.0) out.import.rate = Hertz{raw.rate};
  if (!raw.unit.empty()) out.import.unit = unit_from(raw.unit);
  if (!raw.delimiter.empty()) {
    const bool tab = raw.delimiter == "tab" || raw.delimiter == "\\t";
    if (!tab && raw.delimiter.size() != 1) refuse("--delimiter", "one character, or 'tab'");
    out.import.delimiter = tab ? '\t' : raw.delimiter[0];
  }
  if (raw.header || raw.no_header) out.import.header = raw.header;
  out.import.split_into = raw.split_into;
  return out;
}

study::MeasureOptions measure_from(const Raw& raw) {
  study::MeasureOptions out;
  out.per_octave = raw.per_octave;
  out.confidence = raw.confidence;
  if (raw.robust == "0.6") out.robust = RobustEfficiency::k60;
  if (raw.robust == "0.8") out.robust = RobustEfficiency::k80;
  if (raw.robust == "0.9") out.robust = RobustEfficiency::k90;
  return out;
}

}  // namespace

std::variant<Arguments, int> parse_arguments(int argc, const char* const* argv) {
  CLI::App app("imunoise: noise models of inertial sensors, from static recordings", "imunoise");
  app.footer(kExamples);
  app.set_version_flag("--version", IMUNOISE_VERSION);
  app.require_subcommand(1);
  app.fallthrough();
  std::size_t threads = 0;
  app.add_option("--threads", threads, "Threads to use (results do not depend on it)")
      ->check(CLI::Range(1, 1024));

  Raw raw;
  bool json = false;
  const auto add_json = [&](CLI::App* command) {
    command->add_flag("--json", json, "Print the result as JSON");
  };

  CLI::App* const wv = app.add_subcommand("wv", "Wavelet variance of recordings");
  wv->footer(kWvExamples);
  add_input(*wv, raw);
  add_json(wv);

  CLI::App* const fit = app.add_subcommand("fit", "Fit a noise model to replicates");
  fit->footer(kFitExamples);
  add_input(*fit, raw);
  add_json(fit);
  std::string model;
  std::string estimator = "mugmwm";
  std::string weights = "full";
  std::string report;
  std::string svg;
  fit->add_option("--model", model, fmt::format("The model (default: {})", study::kDefaultModel));
  fit->add_option("--estimator", estimator,
                  "mugmwm: one model for all replicates; agmwm: average of one each")
      ->check(CLI::IsMember({"mugmwm", "agmwm"}))
      ->capture_default_str();
  fit->add_option("--weights", weights,
                  "full: exact covariance of the moments; diag: as the R packages")
      ->check(CLI::IsMember({"full", "diag"}))
      ->capture_default_str();
  fit->add_option("--report", report, "Write one self-contained HTML page")->type_name("OUT.html");
  fit->add_option("--svg", svg, "Write the noise budget as a picture for papers")
      ->type_name("OUT.svg");

  CLI::App* const simulate = app.add_subcommand("simulate", "Write recordings of a known model");
  simulate->footer(kSimulateExamples);
  SimulateArguments simulation;
  double rate = 0.0;
  std::string unit = "1";
  std::string out;
  simulate->add_option("--model", simulation.model, "The model, with all its values")->required();
  simulate->add_option("--rate", rate, "Sampling rate in Hz")
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
  simulate->add_option("--unit", unit, "Unit in which the values are written, e.g. deg/s")
      ->capture_default_str();
  simulate->add_option("--channel", simulation.channel, "Name of the channel")
      ->capture_default_str();
  simulate->add_option("--out", out, "File to write (.h5, .csv, .npy); replicates get _1, _2, ..")
      ->required();
  add_json(simulate);

  CLI::App* const verify = app.add_subcommand("verify", "Check a recording, and repair it");
  verify->footer(kVerifyExamples);
  VerifyArguments verification;
  std::string recording;
  verify->add_option("FOLDER", recording, "A recording's folder, or one chunk file of it")
      ->required()
      ->check(CLI::ExistingPath);
  verify->add_flag("--repair", verification.repair, "Repair what can be repaired");
  add_json(verify);

  try {
    app.parse(argc, argv);
    Arguments arguments;
    if (threads > 0) arguments.threads = threads;
    if (wv->parsed()) {
      arguments.command = WvArguments{input_from(raw), measure_from(raw), json};
    } else if (fit->parsed()) {
      FitArguments command;
      command.input = input_from(raw);
      if (!model.empty()) command.fit.model = model;
      command.fit.estimator =
          estimator == "agmwm" ? study::Estimator::kAGmwm : study::Estimator::kMuGmwm;
      command.fit.weighting = weights == "diag" ? Weighting::kDiagonal : Weighting::kFull;
      command.fit.measure = measure_from(raw);
      command.json = json;
      if (!report.empty()) command.report = report;
      if (!svg.empty()) command.svg = svg;
      arguments.command = std::move(command);
    } else if (verify->parsed()) {
      verification.path = recording;
      verification.json = json;
      if (verification.repair && !std::filesystem::is_directory(verification.path)) {
        refuse("--repair", "one chunk by itself cannot be repaired; name the recording's folder");
      }
      arguments.command = std::move(verification);
    } else {
      simulation.rate = Hertz{rate};
      simulation.unit = unit_from(unit);
      simulation.out = out;
      simulation.json = json;
      arguments.command = std::move(simulation);
    }
    return arguments;
  } catch (const CLI::ParseError& error) {
    const int status = app.exit(error);
    return status == 0 ? 0 : 2;
  }
}

}  // namespace imunoise::cli
