#include "cli/commands/commands.h"
#include "cli/progress_line.h"
#include "cli/show.h"
#include "cli/study_input.h"
#include "study/ladder/study.h"
#include "study/ladder/study_file.h"

namespace imunoise::cli {
namespace {

bool changed_since(const v1::Study& known, const std::filesystem::path& file) {
  const auto now = study::read_study(file);
  return !now || study::study_text(*now) != study::study_text(known);
}

}  // namespace

int run(const StudyArguments& arguments) {
  v1::Study study;
  const bool opens = arguments.request.has_open();
  if (opens && std::filesystem::exists(arguments.file))
    return print_error({arguments.file.string() + ": there is one already; name another file"});
  if (!opens) {
    auto known = study::read_study(arguments.file);
    if (!known) return print_error(known.error());
    study = std::move(*known);
  }
  if (arguments.request.operation_case() != v1::StudyRequest::OPERATION_NOT_SET) {
    const auto& named = opens ? arguments.request.open().witnesses() : study.witnesses();
    const std::vector<std::string> witnesses(named.begin(), named.end());
    const auto read_them = [&](const v1::StudyInput& input, const std::string& channel) {
      return read_study_input(input, channel, witnesses);
    };
    auto done = [&] {
      ProgressLine line("study");
      return study::apply(study, arguments.request, read_them, line.progress(),
                          study::CachePlace{study::user_cache_folder()});
    }();
    if (!done) return print_error(done.error());
    if (!opens && changed_since(study, arguments.file))
      return print_error(
          {arguments.file.string() +
           ": the study file changed while the command ran; nothing was saved. Run it again"});
    study = std::move(*done);
    if (auto saved = write_file(arguments.file, study::study_text(study)); !saved)
      return print_error(saved.error());
  }
  return show(study, arguments.show);
}

}  // namespace imunoise::cli
