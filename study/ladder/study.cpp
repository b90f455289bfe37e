#include "study/ladder/study.h"

#include <fmt/format.h>

#include <algorithm>

#include "study/analysis/diagnose_series.h"
#include "study/analysis/series.h"

namespace imunoise::study {
namespace {

Result<v1::DiagnosisReport> report_of(const v1::Study& study, const std::string& model, bool search,
                                      const ReadInput& read, const Progress& progress) {
  const auto recordings = read(study.input(), study.channel());
  if (!recordings) return tl::unexpected(recordings.error());
  const auto channel = channel_called(study.channel(), recordings->front());
  if (!channel) return tl::unexpected(channel.error());
  DiagnoseOptions options;
  if (!model.empty()) options.model = model;
  options.witnesses.assign(study.witnesses().begin(), study.witnesses().end());
  options.search = search;
  return diagnose_series(*recordings, *channel, options, progress);
}

// Appends an attempt and makes it the current one. Its likelihood is told over that of the first.
Result<void> append(v1::Study& study, std::optional<std::uint32_t> parent, const std::string& model,
                    const std::string& added, const ReadInput& read, const Progress& progress) {
  auto report = report_of(study, model, false, read, progress);
  if (!report) return tl::unexpected(report.error());
  study.set_channel(report->channel());
  v1::StudyAttempt& attempt = *study.add_attempts();
  if (parent) attempt.set_parent(*parent);
  *attempt.mutable_rung() = report->ladder(0);
  attempt.mutable_rung()->set_added(added);
  const double likelihood = attempt.rung().log_likelihood();
  if (!parent) study.set_first_log_likelihood(likelihood);
  attempt.mutable_rung()->set_log_likelihood(likelihood - study.first_log_likelihood());
  study.set_current(static_cast<std::uint32_t>(study.attempts_size() - 1));
  study.clear_diagnosis();
  return {};
}

Result<void> open(v1::Study& study, const v1::StudyRequest::Open& request, const ReadInput& read,
                  const Progress& progress) {
  study.Clear();
  study.set_version(1);
  *study.mutable_input() = request.input();
  study.set_channel(request.channel());
  *study.mutable_witnesses() = request.witnesses();
  return append(study, std::nullopt, request.model(), "", read, progress);
}

Result<void> add(v1::Study& study, const v1::StudyRequest::Add& request, const ReadInput& read,
                 const Progress& progress) {
  const std::uint32_t from = request.has_branch_from() ? request.branch_from() : study.current();
  if (from >= static_cast<std::uint32_t>(study.attempts_size()))
    return fail(
        fmt::format("attempt {}: there are {}, counted from 0", from, study.attempts_size()));
  const std::string model =
      fmt::format("{} + {}", study.attempts(static_cast<int>(from)).rung().model(), request.term());
  return append(study, from, model, request.term(), read, progress);
}

Result<void> undo(v1::Study& study) {
  v1::StudyAttempt& attempt = *study.mutable_attempts(static_cast<int>(study.current()));
  if (!attempt.has_parent()) return fail("nothing to undo: this is the study's first model");
  attempt.set_undone(true);
  study.set_current(attempt.parent());
  study.clear_diagnosis();
  return {};
}

Result<void> seek(v1::Study& study, const ReadInput& read, const Progress& progress) {
  auto report = report_of(study, current_model(study), true, read, progress);
  if (!report) return tl::unexpected(report.error());
  *study.mutable_diagnosis() = std::move(*report);
  return {};
}

}  // namespace

Result<v1::Study> apply(const v1::Study& study, const v1::StudyRequest& request,
                        const ReadInput& read, const Progress& progress) {
  v1::Study out = study;
  Result<void> done;
  switch (request.operation_case()) {
    case v1::StudyRequest::kOpen:
      done = open(out, request.open(), read, progress);
      break;
    case v1::StudyRequest::kCandidates:
      done = seek(out, read, progress);
      break;
    case v1::StudyRequest::kAdd:
      done = add(out, request.add(), read, progress);
      break;
    case v1::StudyRequest::kUndo:
      done = undo(out);
      break;
    case v1::StudyRequest::OPERATION_NOT_SET:
      return fail("the request asks nothing of the study");
  }
  if (!done) return tl::unexpected(done.error());
  return out;
}

const std::string& current_model(const v1::Study& study) {
  return study.attempts(static_cast<int>(study.current())).rung().model();
}

}  // namespace imunoise::study
