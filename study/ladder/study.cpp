#include "study/ladder/study.h"

#include <fmt/format.h>

#include <algorithm>

#include "core/effects/parse_full_model.h"
#include "recording/store/format/crc32c.h"
#include "study/analysis/diagnose_series.h"
#include "study/analysis/evaluate.h"
#include "study/analysis/less_effects.h"
#include "study/analysis/preflights.h"
#include "study/analysis/series.h"
#include "study/analysis/unexplained.h"
#include "study/analysis/vocabulary.h"

namespace imunoise::study {
namespace {

constexpr int kForecasts = 4;  // candidates that are added at once when they are asked for

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

Result<void> same_samples(const v1::Study& study, std::uint32_t samples) {
  if (study.fingerprint() == 0 || study.fingerprint() == samples) return {};
  return fail(
      "the recordings changed since the study was created; restore them, or start a new study");
}

// Whether a witness has as many samples as the channel in each replicate.
bool is_beside(const Witness& witness, const Subject& subject) {
  if (witness.samples.size() != subject.replicates()) return false;
  for (std::size_t k = 0; k < subject.replicates(); ++k) {
    if (witness.samples[k].size() != subject.length(k)) return false;
  }
  return true;
}

// A study tells likelihoods over that of its first model.
void count_from_first(const v1::Study& study, v1::Rung& rung) {
  rung.set_log_likelihood(rung.log_likelihood() - study.first_log_likelihood());
}

// Does what is asked of one study.
class Operation {
 public:
  Operation(v1::Study& study, const ReadInput& read, const Progress& progress,
            const std::optional<CachePlace>& keep)
      : study_(study), read_(read), progress_(progress), keep_(keep) {}

  Result<void> open(const v1::StudyRequest::Open& request);
  Result<void> seek();
  Result<void> add(const v1::StudyRequest::Add& request);
  Result<void> undo();
  Result<void> redo();
  Result<void> try_model(const v1::StudyRequest::TryModel& request);

 private:
  WitnessNames allowed() const {
    if (study_.witnesses().empty()) return std::nullopt;
    return std::vector<std::string>(study_.witnesses().begin(), study_.witnesses().end());
  }
  bool may_name(const std::string& witness) const;
  Result<WitnessNames> needed_by(const std::string& model,
                                 const recording::Replicate& recording) const;
  Result<RecordedChannel> looked(const std::optional<std::string>& model);
  Result<std::optional<PreparedChannel>> seen_before(const std::string& model) const;
  Result<v1::Rung> climbed(const std::string& model, const std::string& added,
                           std::optional<PreparedChannel> prepared, const Progress& progress);

  v1::Study& study_;
  const ReadInput& read_;
  const Progress& progress_;
  const std::optional<CachePlace>& keep_;
  std::optional<CacheFolder> folder_;  // of what was read
};

bool Operation::may_name(const std::string& witness) const {
  const WitnessNames may = allowed();
  return !may || std::find(may->begin(), may->end(), witness) != may->end();
}

// Those that a model follows; all, where it follows one that there is not, so that it can be said
// which there are.
Result<WitnessNames> Operation::needed_by(const std::string& model,
                                          const recording::Replicate& recording) const {
  const auto read = parse_full_model(model, recording.rate);
  if (!read) return tl::unexpected(read.error());
  WitnessNames out = witnesses_of(*read);
  for (const std::string& name : *out) {
    const bool recorded = std::any_of(recording.channels.begin(), recording.channels.end(),
                                      [&](const auto& one) { return one.name == name; });
    if (!recorded || !may_name(name) || name == study_.channel()) return allowed();
  }
  return out;
}

// Reads the recordings: a channel beside the witnesses that a model needs, or all.
Result<RecordedChannel> Operation::looked(const std::optional<std::string>& model) {
  if (keep_) folder_.emplace(study_.input(), *keep_);
  auto recordings = read_(study_.input(), study_.channel());
  if (!recordings) return tl::unexpected(recordings.error());
  const auto channel = channel_called(study_.channel(), recordings->front());
  if (!channel) return tl::unexpected(channel.error());
  const std::uint32_t samples = fingerprint(series_of(*recordings, *channel));
  if (auto same = same_samples(study_, samples); !same) return tl::unexpected(same.error());
  if (auto known = check_witnesses(allowed(), recordings->front()); !known)
    return tl::unexpected(known.error());
  const Result<WitnessNames> witnesses = model ? needed_by(*model, recordings->front()) : allowed();
  if (!witnesses) return tl::unexpected(witnesses.error());
  auto told = preflights(*recordings);
  auto out =
      prepare_channel(std::move(*recordings), *channel, *witnesses, progress_.part(0.0, 0.1));
  if (!out) return out;
  out->prepared.fingerprint = samples;
  study_.set_fingerprint(samples);
  *study_.mutable_preflight() = std::move(told);
  study_.set_channel(out->prepared.name);
  return out;
}

// What was kept, with the witnesses that a model follows; nothing if any of it is missing. Error: a
// model that cannot be read.
Result<std::optional<PreparedChannel>> Operation::seen_before(const std::string& model) const {
  const std::optional<PreparedChannel> nothing;
  if (!keep_ || study_.fingerprint() == 0) return nothing;
  const CacheFolder folder(study_.input(), *keep_);
  auto out = folder.find(study_.channel());
  if (!out || out->fingerprint != study_.fingerprint()) return nothing;
  const auto read = parse_full_model(model, out->subject->rate);
  if (!read) return tl::unexpected(read.error());
  Subject subject = *out->subject;
  for (const std::string& name : witnesses_of(*read)) {
    if (!may_name(name)) return nothing;
    auto witness = folder.find_witness(study_.channel(), name);
    if (!witness || !is_beside(*witness, subject)) return nothing;
    subject.witnesses.push_back(std::move(*witness));
  }
  out->subject = std::make_shared<const Subject>(std::move(subject));
  return out;
}

// Fits a model and judges it. `seen`: where the channel was looked at already.
Result<v1::Rung> Operation::climbed(const std::string& model, const std::string& added,
                                    std::optional<PreparedChannel> prepared,
                                    const Progress& progress) {
  if (!prepared) {
    auto before = seen_before(model);
    if (!before) return tl::unexpected(before.error());
    prepared = std::move(*before);
  }
  if (!prepared) {
    auto look = looked(model);
    if (!look) return tl::unexpected(look.error());
    prepared = std::move(look->prepared);
  }
  auto rung = evaluate(model, *prepared, {.added = added, .why = ""}, progress);
  if (!rung) return rung;
  if (folder_) folder_->keep(*prepared);
  study_.set_unit(std::string(si_symbol(prepared->subject->quantity)));
  study_.set_rate_hz(prepared->subject->rate.value);
  study_.set_replicates(static_cast<std::uint32_t>(prepared->subject->replicates()));
  if (study_.attempts_size() == 0) study_.set_first_log_likelihood(rung->log_likelihood());
  count_from_first(study_, *rung);
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

Result<void> Operation::open(const v1::StudyRequest::Open& request) {
  study_.Clear();
  study_.set_version(1);
  *study_.mutable_input() = request.input();
  study_.set_channel(request.channel());
  *study_.mutable_witnesses() = request.witnesses();
  Result<std::string> model = request.model();
  std::optional<PreparedChannel> prepared;
  if (model->empty()) {
    auto look = looked("WN");  // no model needs fewer witnesses
    if (!look) return tl::unexpected(look.error());
    model = model_for(*look, progress_.part(0.1, 0.5));
    if (!model) return tl::unexpected(model.error());
    prepared = std::move(look->prepared);
  }
  const Progress rest = progress_.part(prepared ? 0.5 : 0.1, 1.0);
  auto rung = climbed(*model, "", std::move(prepared), rest);
  if (!rung) return tl::unexpected(rung.error());
  append(study_, std::nullopt, std::move(*rung));
  return {};
}

Result<void> Operation::add(const v1::StudyRequest::Add& request) {
  const std::uint32_t from = request.has_branch_from() ? request.branch_from() : study_.current();
  if (from >= static_cast<std::uint32_t>(study_.attempts_size()))
    return fail(
        fmt::format("attempt {}: there are {}, counted from 0", from, study_.attempts_size()));
  if (auto known = known_rung(study_, from, request.term())) {
    append(study_, from, std::move(*known));
    return {};
  }
  const std::string& model = study_.attempts(static_cast<int>(from)).rung().model();
  auto rung = climbed(fmt::format("{} + {}", model, request.term()), request.term(), std::nullopt,
                      progress_.part(0.1, 1.0));
  if (!rung) return tl::unexpected(rung.error());
  append(study_, from, std::move(*rung));
  return {};
}

Result<void> Operation::undo() {
  v1::StudyAttempt& attempt = *study_.mutable_attempts(static_cast<int>(study_.current()));
  if (!attempt.has_parent()) return fail("nothing to undo: this is the first model of the study");
  attempt.set_undone(true);
  study_.set_current(attempt.parent());
  study_.clear_diagnosis();
  return {};
}

Result<void> Operation::redo() {
  for (int i = study_.attempts_size() - 1; i >= 0; --i) {
    v1::StudyAttempt& attempt = *study_.mutable_attempts(i);
    if (!attempt.undone() || !attempt.has_parent() || attempt.parent() != study_.current())
      continue;
    attempt.clear_undone();
    study_.set_current(static_cast<std::uint32_t>(i));
    study_.clear_diagnosis();
    return {};
  }
  return fail("nothing to redo: no model that extends the current one was undone");
}

Result<void> Operation::try_model(const v1::StudyRequest::TryModel& request) {
  auto rung = climbed(request.model(), "", std::nullopt, progress_.part(0.1, 1.0));
  if (!rung) return tl::unexpected(rung.error());
  append(study_, study_.current(), std::move(*rung));
  return {};
}

Result<void> Operation::seek() {
  const auto look = looked(std::nullopt);
  if (!look) return tl::unexpected(look.error());
  if (folder_) folder_->keep(look->prepared);
  DiagnoseOptions options;
  options.model = current_model(study_);
  options.forecasts = kForecasts;
  auto report = diagnose_channel(*look, options, progress_.part(0.1, 1.0));
  if (!report) return tl::unexpected(report.error());
  for (v1::EffectCandidate& one : *report->mutable_candidates()) {
    if (one.has_next()) count_from_first(study_, *one.mutable_next());
  }
  *study_.mutable_diagnosis() = std::move(*report);
  return {};
}

}  // namespace

Result<v1::Study> apply(const v1::Study& study, const v1::StudyRequest& request,
                        const ReadInput& read, const Progress& progress,
                        const std::optional<CachePlace>& keep) {
  v1::Study out = study;
  Operation operation(out, read, progress, keep);
  Result<void> done;
  switch (request.operation_case()) {
    case v1::StudyRequest::kOpen:
      done = operation.open(request.open());
      break;
    case v1::StudyRequest::kCandidates:
      done = operation.seek();
      break;
    case v1::StudyRequest::kAdd:
      done = operation.add(request.add());
      break;
    case v1::StudyRequest::kUndo:
      done = operation.undo();
      break;
    case v1::StudyRequest::kRedo:
      done = operation.redo();
      break;
    case v1::StudyRequest::kTryModel:
      done = operation.try_model(request.try_model());
      break;
    case v1::StudyRequest::OPERATION_NOT_SET:
      return fail("the request names no operation on the study");
  }
  if (!done) return tl::unexpected(done.error());
  tell_unexplained(out);
  return out;
}

const std::string& current_model(const v1::Study& study) {
  return study.attempts(static_cast<int>(study.current())).rung().model();
}

}  // namespace imunoise::study
