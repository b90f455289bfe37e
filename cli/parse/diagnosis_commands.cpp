#include <fmt/format.h>

#include "cli/parse/commands.h"
#include "cli/parse/raw_analysis.h"
#include "core/effects/known_effects.h"

namespace imunoise::cli {
namespace {

constexpr const char* kDiagnoseExamples = R"help(
Examples:
  imunoise diagnose run?.h5 --channel gyro_x --model "WN + RW"     effects missing from this model
  imunoise diagnose run?.h5 --channel gyro_x --auto                add effects until none is missing
  imunoise diagnose run?.h5 --channel gyro_x --model "WN + RW + line(f=23.4)"
  imunoise diagnose run?.h5 --channel gyro_x --witness temperature --report diagnosis.html)help";

// "line(f=Hz, harmonics)": what a term needs has a value, all else may be left out. Sizes are what
// a fit finds.
std::string usage_of(const Effect& effect) {
  std::string words = effect.witness ? "CHANNEL" : "";
  for (const EffectParameter& one : effect.parameters) {
    if (one.truth) continue;
    std::string value;
    if (one.required)
      value = one.unit.empty() || one.unit == "1" ? "=N" : fmt::format("={}", one.unit);
    words += fmt::format("{}{}{}", words.empty() ? "" : ", ", one.name, value);
  }
  return words.empty() ? std::string(effect.name) : fmt::format("{}({})", effect.name, words);
}

// The examples, then every effect that a model can hold.
std::string with_effects(const std::string& examples) {
  std::string out = examples + "\n\nEffects in a model:\n";
  for (const Effect* effect : known_effects())
    out += fmt::format("  {}\n      {}\n", usage_of(*effect), effect->meaning);
  return out;
}

void add_witnesses(CLI::App& command, std::vector<std::string>& witnesses) {
  command
      .add_option(
          "--witness", witnesses,
          "Names of the auxiliary channels (witnesses) to consider as causes, separated by commas")
      ->type_name("NAMES")
      ->default_str("all")
      ->delimiter(',')
      ->allow_extra_args(false);
}

ParsedCommand diagnose_command(CLI::App& program) {
  CLI::App* const diagnose =
      program.add_subcommand("diagnose", "Find the physical effect that a model lacks");
  diagnose->footer(with_effects(kDiagnoseExamples));
  const auto raw = std::make_shared<RawAnalysis>();
  const auto options = std::make_shared<study::DiagnoseOptions>();
  add_input(*diagnose, raw->input);
  by_default_of_inertia(*diagnose);
  add_json(*diagnose, *raw);
  add_report(*diagnose, *raw);
  add_model(*diagnose, *raw, "chosen by cross-validation");
  add_witnesses(*diagnose, options->witnesses);
  const auto svg = std::make_shared<std::string>();
  diagnose
      ->add_option(
          "--svg", *svg,
          "SVG pictures of noise budget, spectrum and errors to write, for papers: OUT_before.svg, "
          "OUT_after.svg, OUT_spectrum_before.svg, OUT_spectrum_after.svg, OUT_errors.svg")
      ->type_name("OUT.svg");
  diagnose->add_flag("--auto", options->automatic,
                     "Add the best effect to the model and repeat until none is missing");
  diagnose->add_option("--level", options->level, "False-alarm probability of the whole search")
      ->type_name("PROBABILITY")
      ->check(CLI::Range(1e-6, 0.5))
      ->capture_default_str();
  return {diagnose, [raw, options, svg] {
            DiagnoseArguments out{input_from(raw->input), {}, *options, show_from(*raw)};
            out.channels = out.input.import.channels;
            out.diagnose.model = model_from(*raw);
            if (!svg->empty()) out.svg = output_from("--svg", *svg, *raw);
            return out;
          }};
}

constexpr const char* kStudyExamples = R"help(
Examples:
  imunoise study new gyro.study run?.h5 --channel gyro_x --model "WN + RW"
  imunoise study candidates gyro.study                 effects that the model lacks
  imunoise study add gyro.study "line(f=7.123)"        add one, and see how the error changes
  imunoise study undo gyro.study
  imunoise study add gyro.study QN --from 0            add to the first model instead
  imunoise study show gyro.study
  imunoise study report gyro.study ladder.html)help";

// What the parts of `study` share.
struct RawStudy {
  RawAnalysis raw;
  std::string file;
  std::string term;
  int from = -1;
  std::vector<std::string> witnesses;
};

v1::StudyRequest open_request(const RawStudy& typed) {
  if (typed.raw.input.channels.size() > 1)
    refuse("--channel", "give one channel; a study has only one");
  v1::StudyRequest out;
  v1::StudyRequest::Open& open = *out.mutable_open();
  const RawInput& raw = typed.raw.input;
  *open.mutable_input() = study_input_from(raw);
  if (!raw.channels.empty()) open.set_channel(raw.channels.front());
  for (const std::string& one : typed.witnesses) open.add_witnesses(one);
  open.set_model(typed.raw.model);
  return out;
}

std::vector<ParsedCommand> study_commands(CLI::App& program) {
  CLI::App* const study =
      program.add_subcommand("study", "Improve a model step by step and keep every attempt");
  study->footer(kStudyExamples);
  study->require_subcommand(1);
  std::vector<ParsedCommand> out;
  // A part of the command; `request` makes what it asks for.
  const auto add = [&](const char* name, const char* about, const std::string& examples,
                       const auto& options,
                       const std::function<v1::StudyRequest(const RawStudy&)>& request) {
    CLI::App* const part = study->add_subcommand(name, about);
    part->footer("Examples:\n  imunoise study " + examples);
    const auto typed = std::make_shared<RawStudy>();
    part->add_option("STUDY", typed->file, "Study file")->required();
    options(*part, *typed);
    add_json(*part, typed->raw);
    out.push_back({part, [typed, request] {
                     if (typed->raw.report == typed->file)
                       refuse("OUT", "is the study file itself; name another file");
                     return StudyArguments{typed->file, request(*typed), show_from(typed->raw)};
                   }});
  };
  const auto no_options = [](CLI::App&, RawStudy&) {};
  add(
      "new", "Start a study: create its file",
      "new gyro.study run?.h5 --channel gyro_x --model \"WN + RW\"",
      [](CLI::App& part, RawStudy& typed) {
        add_input(part, typed.raw.input);
        add_model(part, typed.raw, "chosen by cross-validation");
        add_witnesses(part, typed.witnesses);
      },
      open_request);
  add("show", "Show all attempts and their errors", "show gyro.study", no_options,
      [](const RawStudy&) { return v1::StudyRequest(); });
  add("candidates", "Find effects that the current model lacks", "candidates gyro.study",
      no_options, [](const RawStudy&) {
        v1::StudyRequest request;
        request.mutable_candidates();
        return request;
      });
  add(
      "add", "Add a term to the current model",
      "add gyro.study \"line(f=7.123)\"\n"
      "  imunoise study add gyro.study QN --from 0            add to the first model instead",
      [](CLI::App& part, RawStudy& typed) {
        part.add_option("TERM", typed.term, "Process or effect, such as QN or line(f=7.123)")
            ->required();
        part.add_option("--from", typed.from, "Number of the attempt to add to")
            ->type_name("NUMBER")
            ->default_str("the current one")
            ->check(zero_or_above());
      },
      [](const RawStudy& typed) {
        v1::StudyRequest request;
        request.mutable_add()->set_term(typed.term);
        if (typed.from >= 0)
          request.mutable_add()->set_branch_from(static_cast<std::uint32_t>(typed.from));
        return request;
      });
  add("undo", "Return to the attempt that the current one extends", "undo gyro.study", no_options,
      [](const RawStudy&) {
        v1::StudyRequest request;
        request.mutable_undo();
        return request;
      });
  add("redo", "Take the last undo back", "redo gyro.study", no_options, [](const RawStudy&) {
    v1::StudyRequest request;
    request.mutable_redo();
    return request;
  });
  add(
      "try", "Try another model beside the current one", "try gyro.study \"WN + RW + QN\"",
      [](CLI::App& part, RawStudy& typed) {
        part.add_option("MODEL", typed.term, "Model with its effects, such as \"WN + RW\"")
            ->required();
      },
      [](const RawStudy& typed) {
        v1::StudyRequest request;
        request.mutable_try_model()->set_model(typed.term);
        return request;
      });
  add(
      "report", "Write an HTML report of the study", "report gyro.study ladder.html",
      [](CLI::App& part, RawStudy& typed) {
        part.add_option("OUT", typed.raw.report, "HTML file to write")->required();
      },
      [](const RawStudy&) {
        v1::StudyRequest request;
        request.mutable_candidates();
        return request;
      });
  return out;
}

}  // namespace

std::vector<ParsedCommand> diagnosis_commands(CLI::App& program) {
  std::vector<ParsedCommand> out = study_commands(program);
  out.push_back(diagnose_command(program));
  return out;
}

}  // namespace imunoise::cli
