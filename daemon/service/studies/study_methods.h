#pragma once

#include "daemon/service/api/methods.h"
#include "daemon/service/recordings/records.h"
#include "daemon/service/studies/jobs.h"
#include "daemon/service/studies/study_computation.h"
#include "daemon/service/studies/study_store.h"

namespace imunoise::service {

/// What the methods work on; it outlives them.
struct StudySubjects {
  Jobs& jobs;
  StudyStore& studies;
  const Records& records;
  const std::vector<v1::NamedInput>& inputs;
};

/// Studies and jobs. `largest_recording`: bytes of a recording's chunks; a larger one would need
/// too much memory beside recording. `compute` does the work of the jobs.
void add_study_methods(Methods& methods, const StudySubjects& subjects,
                       std::uint64_t largest_recording, ComputeStudy compute);

}  // namespace imunoise::service
