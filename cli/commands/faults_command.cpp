#include <algorithm>

#include "cli/commands/commands.h"
#include "cli/input.h"
#include "cli/progress_line.h"
#include "cli/show.h"
#include "study/analysis/preflights.h"

namespace imunoise::cli {
namespace {

bool same_file(const std::filesystem::path& one, const std::filesystem::path& other) {
  std::error_code ignored;  // of files that are not there, which reading tells
  return std::filesystem::equivalent(one, other, ignored);
}

// What a fault did to a file is left out where noise is learnt, and searched. Of a recording
// nothing is left out.
InputArguments with_faults(InputArguments input) {
  if (is_recording(input)) return input;
  input.import.use_disturbed = true;
  input.import.use_frozen = true;
  return input;
}

bool is_cut(const recording::Replicate& one) {
  return one.preflight != nullptr && one.preflight->stretches > 1;
}

// Those that are not searched.
InputArguments others(InputArguments training, const InputArguments& searched) {
  std::erase_if(training.files, [&](const auto& one) {
    return std::any_of(searched.files.begin(), searched.files.end(),
                       [&](const auto& other) { return same_file(one, other); });
  });
  return training;
}

}  // namespace

int run(const FaultsArguments& arguments) {
  const InputArguments training = others(arguments.training, arguments.input);
  const bool elsewhere = !training.files.empty();
  const auto replicates = read_together(with_faults(arguments.input));
  if (!replicates) return print_error(replicates.error());
  const auto good = elsewhere                       ? read_together(training)
                    : is_recording(arguments.input) ? replicates
                                                    : read_again(arguments.input);
  if (!good) return print_error(good.error());
  auto done = [&] {
    ProgressLine line("searching");
    return study::fault_series(all_series(*replicates), {all_series(*good), elsewhere},
                               arguments.faults, line.progress());
  }();
  if (!done) return print_error(done.error());
  if (elsewhere && training.files.size() < arguments.training.files.size())
    done->add_notes("The files that are searched were left out of those to train on.");
  if (std::any_of(replicates->begin(), replicates->end(), is_cut))
    done->add_notes(
        "A file was cut at gaps. After each, the levels are learnt anew: a sensor that comes back "
        "with another level looks sound.");
  study::add_preflight(*replicates, *done);
  return show(*done, arguments.show);
}

}  // namespace imunoise::cli
