#include "cli/parse/input_options.h"

#include <cmath>

#include "recording/import/table/time_names.h"

namespace imunoise::cli {
namespace {

CLI::Validator number_check(const char* name, const char* words, bool (*good)(double)) {
  return {[words, good](const std::string& text) -> std::string {
            double value = 0.0;
            if (CLI::detail::lexical_cast(text, value) && good(value)) return "";
            return "'" + text + "' is not " + words;
          },
          name};
}

}  // namespace

CLI::Validator above_zero() {
  return number_check("above 0", "a number above zero",
                      [](double value) { return std::isfinite(value) && value > 0.0; });
}

CLI::Validator zero_or_above() {
  return number_check("at least 0", "zero or a number above it",
                      [](double value) { return std::isfinite(value) && value >= 0.0; });
}

void by_default_of_inertia(CLI::App& command) {
  command.get_option("--channel")->default_str("angular rates and accelerations");
}

void add_input(CLI::App& command, RawInput& raw) {
  command
      .add_option("FILES", raw.files,
                  "Recordings, one replicate each: CSV, bags of ROS, MATLAB, HDF5, NumPy and "
                  "others; or the "
                  "folder of one recording")
      ->required();
  command
      .add_option("--channel", raw.channels,
                  "Names of the channels to analyse, separated by commas")
      ->type_name("NAMES")
      ->default_str("all")
      ->delimiter(',')
      ->allow_extra_args(false);  // what follows the name is a file again
  command
      .add_option("--rate", raw.rate,
                  "Sampling rate (Hz), instead of what files state or their times show")
      ->type_name("HZ")
      ->check(above_zero());
  command
      .add_option("--unit", raw.unit,
                  "Units of the channels, such as deg/s or 'gyro_*=deg/s,acc_*=g'; they override "
                  "the file's")
      ->type_name("UNITS");
  command.add_option("--time-unit", raw.time_unit, "Unit of the time column of files")
      ->check(CLI::IsMember({"h", "min", "s", "ms", "us", "ns"}))
      ->default_str("recognised");
  command.add_option("--from", raw.from, "Start of the samples to use (s after a file's first)")
      ->type_name("SECONDS")
      ->check(zero_or_above());
  command.add_option("--until", raw.until, "End of the samples to use (s after a file's first)")
      ->type_name("SECONDS")
      ->check(above_zero());
  command
      .add_option("--exclude", raw.exclude,
                  "Times to leave out (s after a file's first sample), such as 2990..3010; none: "
                  "also use times of disturbance")
      ->type_name("SPANS")
      ->delimiter(',')
      ->allow_extra_args(false);
  command.add_flag("--strict", raw.strict,
                   "Refuse files with faults instead of leaving samples out");
  command.add_option("--topic", raw.topic, "Topic of a bag, such as /imu/data")
      ->type_name("NAME")
      ->default_str("the only one of an IMU");
  command
      .add_option("--dbc", raw.dbc,
                  "Database of messages for a log of a CAN bus: a DBC file, or mti600, aceinna or "
                  "mm5.10")
      ->type_name("FILE");
  command
      .add_option("--delimiter", raw.delimiter, "Separator of a text file: one character, or 'tab'")
      ->type_name("CHARACTER")
      ->default_str("detected");
  auto* const header =
      command.add_flag("--header", raw.header, "Read the first row of a text file as names");
  command.add_flag("--no-header", raw.no_header, "Read the first row of a text file as numbers")
      ->excludes(header);
  command
      .add_option("--split-into", raw.split_into,
                  "Number of equal replicates to cut each file into")
      ->check(CLI::Range(1, 100000))
      ->type_name("COUNT")
      ->capture_default_str();
}

void add_scales(CLI::App& command, RawInput& raw) {
  command.add_option("--per-octave", raw.per_octave, "Wavelet scales per octave")
      ->check(CLI::IsMember({1, 2, 4}))
      ->capture_default_str();
}

void add_measure(CLI::App& command, RawInput& raw) {
  add_scales(command, raw);
  command
      .add_option(
          "--robust", raw.robust,
          "Efficiency of the robust estimator; lower values resist more outliers, at averaging "
          "times shorter than the time between two of them")
      ->check(CLI::IsMember({"0.6", "0.8", "0.9"}))
      ->default_str("not robust");
}

void refuse(const std::string& option, const std::string& why) {
  throw CLI::ValidationError(option, why);
}

Unit unit_from(const std::string& text) {
  const Result<Unit> unit = parse_unit(text);
  if (!unit) refuse("--unit", unit.error().message);
  return *unit;
}

// "deg/s", or "gyro_*=deg/s,acc_*=g".
std::vector<recording::UnitRule> unit_rules_from(const std::string& text) {
  if (text.find('=') == std::string::npos) return {{"*", unit_from(text)}};
  std::vector<recording::UnitRule> out;
  for (const std::string& rule : CLI::detail::split(text, ',')) {
    const std::size_t equals = rule.find('=');
    if (equals == std::string::npos || equals == 0)
      refuse("--unit", "'" + rule + "' is not NAME=UNIT");
    out.push_back({rule.substr(0, equals), unit_from(rule.substr(equals + 1))});
  }
  return out;
}

std::vector<recording::TimeSpan> spans_from(const std::vector<std::string>& texts) {
  std::vector<recording::TimeSpan> out;
  for (const std::string& text : texts) {
    if (text == "none") refuse("--exclude", "'none' stands alone: give it without times");
    const std::size_t dots = text.find("..");
    recording::TimeSpan span;
    if (dots == std::string::npos || !CLI::detail::lexical_cast(text.substr(0, dots), span.begin) ||
        !CLI::detail::lexical_cast(text.substr(dots + 2), span.end) || !(span.begin < span.end))
      refuse("--exclude",
             "'" + text + "' is neither none nor a range of times, such as 2990..3010");
    out.push_back(span);
  }
  return out;
}

RawInput raw_from(const v1::StudyInput& input) {
  RawInput out;
  out.files.assign(input.files().begin(), input.files().end());
  out.rate = input.rate_hz();
  out.unit = input.unit();
  out.delimiter = input.delimiter();
  out.header = input.header();
  out.no_header = input.no_header();
  if (input.split_into() > 1) out.split_into = input.split_into();
  out.time_unit = input.time_unit();
  if (input.has_from()) out.from = input.from();
  if (input.has_until()) out.until = input.until();
  out.exclude.assign(input.exclude().begin(), input.exclude().end());
  out.strict = input.strict();
  out.topic = input.topic();
  out.dbc = input.dbc();
  return out;
}

v1::StudyInput study_input_from(const RawInput& raw) {
  static_cast<void>(input_from(raw));  // refuses what cannot be read
  v1::StudyInput out;
  for (const std::string& file : raw.files) out.add_files(std::filesystem::absolute(file).string());
  out.set_rate_hz(raw.rate);
  out.set_unit(raw.unit);
  out.set_delimiter(raw.delimiter);
  out.set_header(raw.header);
  out.set_no_header(raw.no_header);
  out.set_split_into(static_cast<std::uint32_t>(raw.split_into));
  out.set_time_unit(raw.time_unit);
  if (raw.from) out.set_from(*raw.from);
  if (raw.until) out.set_until(*raw.until);
  *out.mutable_exclude() = {raw.exclude.begin(), raw.exclude.end()};
  out.set_strict(raw.strict);
  out.set_topic(raw.topic);
  if (!raw.dbc.empty()) out.set_dbc(std::filesystem::absolute(raw.dbc).string());
  return out;
}

InputArguments input_from(const RawInput& raw) {
  InputArguments out;
  out.files.assign(raw.files.begin(), raw.files.end());
  // Looked for here and not while parsing, where the value of an option that a command does not
  // know would be taken for a file, and be the first thing complained of.
  for (const std::filesystem::path& file : out.files) {
    if (!std::filesystem::exists(file)) refuse("FILES", file.string() + ": no such file or folder");
  }
  if (!(raw.channels.size() == 1 && raw.channels[0] == "all")) out.import.channels = raw.channels;
  if (raw.rate > 0.0) out.import.rate = Hertz{raw.rate};
  if (!raw.unit.empty()) out.import.units = unit_rules_from(raw.unit);
  if (!raw.time_unit.empty())
    out.import.time_unit = *recording::time_unit("", raw.time_unit).value();
  out.import.from = raw.from;
  out.import.until = raw.until;
  out.import.use_disturbed = raw.exclude == std::vector<std::string>{"none"};
  if (!out.import.use_disturbed) out.import.exclude = spans_from(raw.exclude);
  out.import.strict = raw.strict;
  out.import.topic = raw.topic;
  out.import.dbc = raw.dbc;
  if (!raw.delimiter.empty()) {
    const bool tab = raw.delimiter == "tab" || raw.delimiter == "\\t";
    if (!tab && raw.delimiter.size() != 1) refuse("--delimiter", "one character, or 'tab'");
    out.import.delimiter = tab ? '\t' : raw.delimiter[0];
  }
  if (raw.header || raw.no_header) out.import.header = raw.header;
  out.import.split_into = raw.split_into;
  return out;
}

study::MeasureOptions measure_from(const RawInput& raw) {
  study::MeasureOptions out;
  out.per_octave = raw.per_octave;
  if (raw.robust == "0.6") out.robust = RobustEfficiency::k60;
  if (raw.robust == "0.8") out.robust = RobustEfficiency::k80;
  if (raw.robust == "0.9") out.robust = RobustEfficiency::k90;
  return out;
}

}  // namespace imunoise::cli
