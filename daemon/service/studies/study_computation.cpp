#include "daemon/service/studies/study_computation.h"

#include <algorithm>

#include "daemon/service/recordings/confined_files.h"
#include "recording/store/reading/replicates.h"
#include "study/ladder/study.h"

namespace imunoise::service {

Result<v1::Study> compute_here(const v1::JobOrder& order, const Progress& progress) {
  const auto files = confined_files({order.folders().begin(), order.folders().end()});
  const auto read = [&](const v1::StudyInput& input,
                        const std::string& channel) -> Result<std::vector<recording::Replicate>> {
    if (input.files_size() != 1) return fail("the study has several files; use imunoise study");
    recording::ImportOptions options;
    options.beside = true;
    if (!channel.empty()) options.channels = {channel};
    options.split_into = std::max(1U, input.split_into());
    const Progress only_stopping = progress.part(0.0, 0.0);
    return recording::import_recording(*files, input.files(0), options, only_stopping);
  };
  // What a recording showed is known only to who may read it.
  const bool opens = order.request().has_open();
  const v1::StudyInput& input = opens ? order.request().open().input() : order.study().input();
  const bool may = input.files_size() == 1 && files->list(input.files(0));
  constexpr std::uintmax_t kMost = std::uintmax_t{1} << 30U;  // recordings need the disk
  std::optional<study::CachePlace> keep;
  if (may) keep = study::CachePlace{order.cache(), kMost};
  return study::apply(order.study(), order.request(), read, progress, keep);
}

}  // namespace imunoise::service
