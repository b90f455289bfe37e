#include "cli/parse/commands.h"
#include "cli/parse/raw_analysis.h"

namespace imunoise::cli {
namespace {

constexpr const char* kDiagnoseExamples = R"help(
Examples:
  imunoise diagnose run?.h5 --channel gyro_x --model "WN + RW"     what does this model lack?
  imunoise diagnose run?.h5 --channel gyro_x --auto                add what is found, and go on
  imunoise diagnose run?.h5 --channel gyro_x --model "WN + RW + line(f=23.4)"
  imunoise diagnose run?.h5 --channel gyro_x --witness temperature --report diagnosis.html

Effects in a model: ramp, warm_up(tau=600), line(f=0.5, harmonics=3), step(replicate=2, t=1234),
witness(CHANNEL, lag=300), witness(CHANNEL, quadratic), modulated(CHANNEL), outliers(above=6),
telegraph, own_powers.)help";

void add_witnesses(CLI::App& command, std::vector<std::string>& witnesses) {
  command
      .add_option("--witness", witnesses,
                  "A channel that may be the cause, by name; no other is read (default: all)")
      ->delimiter(',')
      ->allow_extra_args(false);
}

ParsedCommand diagnose_command(CLI::App& program) {
  CLI::App* const diagnose =
      program.add_subcommand("diagnose", "Which physical effect is missing from a model?");
  diagnose->footer(kDiagnoseExamples);
  const auto raw = std::make_shared<RawAnalysis>();
  const auto options = std::make_shared<study::DiagnoseOptions>();
  add_input(*diagnose, raw->input);
  add_json(*diagnose, *raw);
  add_report(*diagnose, *raw);
  add_model(*diagnose, *raw, "chosen by cross-validation");
  add_witnesses(*diagnose, options->witnesses);
  const auto svg = std::make_shared<std::string>();
  diagnose
      ->add_option(
          "--svg", *svg,
          "Write noise budget and spectrum as pictures for papers: OUT_before.svg, OUT_after.svg, "
          "OUT_spectrum_before.svg, OUT_spectrum_after.svg")
      ->type_name("OUT.svg");
  diagnose->add_flag("--auto", options->automatic,
                     "Add what is found to the model and look again, until nothing is missing");
  diagnose->add_option("--level", options->level, "Chance of a false alarm over all that is tried")
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
  imunoise study candidates gyro.study                 what does it lack?
  imunoise study add gyro.study "line(f=7.123)"        add it, and see the error
  imunoise study undo gyro.study
  imunoise study add gyro.study QN --from 0            another branch, from the first model
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
  if (typed.raw.input.channels.size() > 1) refuse("--channel", "a study is about one channel");
  static_cast<void>(input_from(typed.raw.input));  // refuses what cannot be read
  v1::StudyRequest out;
  v1::StudyRequest::Open& open = *out.mutable_open();
  const RawInput& raw = typed.raw.input;
  for (const std::string& file : raw.files)
    open.mutable_input()->add_files(std::filesystem::absolute(file).string());
  open.mutable_input()->set_rate_hz(raw.rate);
  open.mutable_input()->set_unit(raw.unit);
  open.mutable_input()->set_delimiter(raw.delimiter);
  open.mutable_input()->set_header(raw.header);
  open.mutable_input()->set_no_header(raw.no_header);
  open.mutable_input()->set_split_into(static_cast<std::uint32_t>(raw.split_into));
  if (!raw.channels.empty()) open.set_channel(raw.channels.front());
  for (const std::string& one : typed.witnesses) open.add_witnesses(one);
  open.set_model(typed.raw.model);
  return out;
}

std::vector<ParsedCommand> study_commands(CLI::App& program) {
  CLI::App* const study =
      program.add_subcommand("study", "Improve a model step by step, and keep every step");
  study->footer(kStudyExamples);
  study->require_subcommand(1);
  std::vector<ParsedCommand> out;
  // A part of the command; `request` makes what it asks for.
  const auto add = [&](const char* name, const char* about, const auto& options,
                       const std::function<v1::StudyRequest(const RawStudy&)>& request) {
    CLI::App* const part = study->add_subcommand(name, about);
    const auto typed = std::make_shared<RawStudy>();
    part->add_option("STUDY", typed->file, "The study's file")->required();
    options(*part, *typed);
    add_json(*part, typed->raw);
    out.push_back({part, [typed, request] {
                     if (typed->raw.report == typed->file) refuse("OUT", "is the study's own file");
                     return StudyArguments{typed->file, request(*typed), show_from(typed->raw)};
                   }});
  };
  const auto no_options = [](CLI::App&, RawStudy&) {};
  add(
      "new", "Start a study",
      [](CLI::App& part, RawStudy& typed) {
        add_input(part, typed.raw.input);
        add_model(part, typed.raw, "chosen by cross-validation");
        add_witnesses(part, typed.witnesses);
      },
      open_request);
  add("show", "The ladder as it stands", no_options,
      [](const RawStudy&) { return v1::StudyRequest(); });
  add("candidates", "Seek what the current model lacks", no_options, [](const RawStudy&) {
    v1::StudyRequest request;
    request.mutable_candidates();
    return request;
  });
  add(
      "add", "Add a term to the current model",
      [](CLI::App& part, RawStudy& typed) {
        part.add_option("TERM", typed.term, "In the grammar: line(f=7.123), QN")->required();
        part.add_option("--from", typed.from, "Add to this attempt instead of the current one")
            ->check(zero_or_above());
      },
      [](const RawStudy& typed) {
        v1::StudyRequest request;
        request.mutable_add()->set_term(typed.term);
        if (typed.from >= 0)
          request.mutable_add()->set_branch_from(static_cast<std::uint32_t>(typed.from));
        return request;
      });
  add("undo", "Back to what the current model was added to", no_options, [](const RawStudy&) {
    v1::StudyRequest request;
    request.mutable_undo();
    return request;
  });
  add(
      "report", "Write the page",
      [](CLI::App& part, RawStudy& typed) {
        part.add_option("OUT", typed.raw.report, "The page's file")->required();
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
