#include "cli/parse/commands.h"
#include "cli/parse/input_options.h"

namespace imunoise::cli {
namespace {

constexpr const char* kOpenExamples = R"help(
Examples:
  imunoise open run?.h5                      compare models with data, see what they lack
  imunoise open recordings/monday            all channels of a recording
  imunoise open gyro.study                   go on with a study
  imunoise open run?.h5 --no-browser --port 8080     for ssh -L 8080:localhost:8080)help";

struct RawOpen {
  RawInput input;
  std::string studies;
  std::uint16_t port = 0;
  bool no_browser = false;
};

// A study's file: its folder, and its name.
OpenArguments open_study(const std::filesystem::path& file, const RawOpen& typed) {
  if (!typed.studies.empty()) refuse("--studies", "is the folder of the study; leave it out");
  if (!std::filesystem::is_regular_file(file)) refuse("FILES", file.string() + ": not found");
  OpenArguments out;
  out.study = file.stem().string();
  out.studies = std::filesystem::absolute(file).parent_path();
  return out;
}

OpenArguments arguments_from(const RawOpen& typed) {
  OpenArguments out;
  const std::filesystem::path first = typed.input.files.front();
  if (typed.input.files.size() == 1 && first.extension() == ".study") {
    out = open_study(first, typed);
  } else {
    out.input = study_input_from(typed.input);
    out.channels = typed.input.channels;
    out.studies = typed.studies;
  }
  out.port = typed.port;
  out.browser = !typed.no_browser;
  return out;
}

}  // namespace

std::vector<ParsedCommand> open_commands(CLI::App& program) {
  CLI::App* const open =
      program.add_subcommand("open", "Compare models with data in the browser, and improve them");
  open->footer(kOpenExamples);
  const auto typed = std::make_shared<RawOpen>();
  add_input(*open, typed->input);
  open->add_option("--studies", typed->studies, "Folder of the studies")
      ->type_name("FOLDER")
      ->default_str("~/.local/share/imunoise/studies");
  open->add_option("--port", typed->port, "Port of 127.0.0.1 to listen on")
      ->type_name("NUMBER")
      ->check(CLI::Range(1, 65'535))
      ->default_str("one that is free");
  open->add_flag("--no-browser", typed->no_browser, "Only print the address of the page");
  return {{open, [typed]() -> Arguments::Command { return arguments_from(*typed); }}};
}

}  // namespace imunoise::cli
