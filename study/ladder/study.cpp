#include "study/ladder/study.h"

#include <fmt/format.h>

#include <algorithm>

#include "recording/store/crc32c.h"
#include "study/analysis/diagnose_series.h"
#include "study/analysis/series.h"

namespace imunoise::study {
namespace {

constexpr int kForetold = 4;  // candidates that are added at once when they are asked for

// Tells recordings of other samples apart: by their lengths and every 61st sample.
std::uint32_t fingerprint(const Series& series) {
  std::vector<double> kept;
  for (const Signal& one : series.replicates) {
    kept.push_back(static_cast<double>(one.size()));
    for (std::size_t t = 0; t < one.size(); t += 61) kept.push_back(one.value(t));
  }
  return recording::crc32c(
      {reinterpret_cast<const char*>(kept.data()), kept.size() * sizeof(double)});
}

Result<v1::DiagnosisReport> report_of(v1::Study& study, const std::string& model, bool search,
                                      const ReadInput& read, const Progress& progress) {
  const auto recordings = read(study.input(), study.channel());
  if (!recordings) return tl::unexpected(recordings.error());
  const auto channel = channel_called(study.channel(), recordings->front());
  if (!channel) return tl::unexpected(channel.error());
  const std::uint32_t samples = fingerprint(series_of(*recordings, *channel));
  if (study.fingerprint() != 0 && study.fingerprint() != samples)
    return fail("the recordings are not those that the study began with; start another study");
  study.set_fingerprint(samples);
  DiagnoseOptions options;
  if (!model.empty()) options.model = model;
  options.witnesses.assign(study.witnesses().begin(), study.witnesses().end());
  options.search = search;
  options.foretold = search ? kForetold : 0;
  return diagnose_series(*recordings, *channel, options, progress);
}

// A study tells likelihoods over that of its first model.
void count_from_first(const v1::Study& study, v1::Rung& rung) {
  rung.set_log_likelihood(rung.log_likelihood() - study.first_log_likelihood());
}

// Fits a model and judges it.
Result<v1::Rung> climbed(v1::Study& study, const std::string& model, const std::string& added,
                         const ReadInput& read, const Progress& progress) {
  auto report = report_of(study, model, false, read, progress);
  if (!report) return tl::unexpected(report.error());
  study.set_channel(report->channel());
  v1::Rung rung = std::move(*report->mutable_ladder(0));
  rung.set_added(added);
  if (study.attempts_size() == 0) study.set_first_log_likelihood(rung.log_likelihood());
  count_from_first(study, rung);
  return rung;
}

// The rung that adding a term to an attempt gives, where that is known: it came with the current
// model's candidates, or was tried before.
std::optional<v1::Rung> known_rung(const v1::Study& study, std::uint32_t from,
                                   const std::string& term) {
  if (from == study.current()) {
    for (const v1::EffectCandidate& one : study.diagnosis().candidates()) {
      if (one.has_next() && one.term() == term) return one.next();
    }
  }
  for (const v1::StudyAttempt& one : study.attempts()) {
    if (one.has_parent() && one.parent() == from && one.rung().added() == term) return one.rung();
  }
  return std::nullopt;
}

// Makes a rung the current attempt.
void append(v1::Study& study, std::optional<std::uint32_t> parent, v1::Rung rung) {
  v1::StudyAttempt& attempt = *study.add_attempts();
  if (parent) attempt.set_parent(*parent);
  *attempt.mutable_rung() = std::move(rung);
  study.set_current(static_cast<std::uint32_t>(study.attempts_size() - 1));
  study.clear_diagnosis();
}

Result<void> open(v1::Study& study, const v1::StudyRequest::Open& request, const ReadInput& read,
                  const Progress& progress) {
  study.Clear();
  study.set_version(1);
  *study.mutable_input() = request.input();
  study.set_channel(request.channel());
  *study.mutable_witnesses() = request.witnesses();
  auto rung = climbed(study, request.model(), "", read, progress);
  if (!rung) return tl::unexpected(rung.error());
  append(study, std::nullopt, std::move(*rung));
  return {};
}

Result<void> add(v1::Study& study, const v1::StudyRequest::Add& request, const ReadInput& read,
                 const Progress& progress) {
  const std::uint32_t from = request.has_branch_from() ? request.branch_from() : study.current();
  if (from >= static_cast<std::uint32_t>(study.attempts_size()))
    return fail(
        fmt::format("attempt {}: there are {}, counted from 0", from, study.attempts_size()));
  if (auto known = known_rung(study, from, request.term())) {
    append(study, from, std::move(*known));
    return {};
  }
  const std::string& model = study.attempts(static_cast<int>(from)).rung().model();
  auto rung =
      climbed(study, fmt::format("{} + {}", model, request.term()), request.term(), read, progress);
  if (!rung) return tl::unexpected(rung.error());
  append(study, from, std::move(*rung));
  return {};
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
  for (v1::EffectCandidate& one : *report->mutable_candidates()) {
    if (one.has_next()) count_from_first(study, *one.mutable_next());
  }
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
