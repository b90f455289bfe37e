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
own_powers.)help";

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
  diagnose
      ->add_option("--witness", options->witnesses,
                   "A channel that may be the cause; may be repeated (default: all others)")
      ->allow_extra_args(false);
  diagnose->add_flag("--auto", options->automatic,
                     "Add what is found to the model and look again, until nothing is missing");
  diagnose->add_option("--level", options->level, "Chance of a false alarm over all that is tried")
      ->check(CLI::Range(1e-6, 0.5))
      ->capture_default_str();
  return {diagnose, [raw, options] {
            if (!raw->input.robust.empty()) refuse("--robust", "not for diagnosis");
            if (raw->input.per_octave != 1) refuse("--per-octave", "not for diagnosis");
            DiagnoseArguments out{input_from(raw->input), {}, *options, show_from(*raw)};
            // All channels are read: those that are not diagnosed are witnesses.
            out.channels = std::exchange(out.input.import.channels, {});
            out.diagnose.model = model_from(*raw);
            return out;
          }};
}

}  // namespace

std::vector<ParsedCommand> diagnosis_commands(CLI::App& program) {
  return {diagnose_command(program)};
}

}  // namespace imunoise::cli
