#include "study/analysis/select_model.h"

#include <fmt/format.h>

#include <algorithm>

#include "core/effects/parse_full_model.h"
#include "study/analysis/prepare.h"
#include "study/analysis/vocabulary.h"

namespace imunoise::study {
namespace {

constexpr std::size_t kBlocks = 6;            // of a single recording
constexpr double kFarFromFloor = 1.5;         // merit
constexpr std::size_t kLeastSamples = 1'024;  // of a block
constexpr std::size_t kMostForHalves = 20;    // replicates; half splits are 184,756 then
constexpr std::size_t kFewReplicates = 5;     // below which intervals between replicates are wide

// A recording in parts of equal length, as if each were a replicate.
Series in_blocks(const Series& series) {
  const Signal& whole = series.replicates.front();
  const std::size_t size = whole.size() / kBlocks;
  Series out{series.channel, {}, {}, {}};
  for (std::size_t b = 0; b < kBlocks; ++b) {
    out.names.push_back(fmt::format("{} [{}/{}]", series.names.front(), b + 1, kBlocks));
    out.replicates.push_back(whole.part(b * size, size));
  }
  return out;
}

Result<std::vector<FullModel>> read_models(const std::vector<std::string>& texts, Hertz rate) {
  std::vector<FullModel> out;
  for (const std::string& text : texts) {
    if (auto done = add_candidate(text, rate, "imunoise select", out); !done)
      return tl::unexpected(done.error());
  }
  return out;
}

// The one whose noise leaves least to effects.
const FullModel& largest(const std::vector<FullModel>& models) {
  return *std::max_element(models.begin(), models.end(), [](const auto& a, const auto& b) {
    return free_parameters(a.noise) < free_parameters(b.noise);
  });
}

// The noise of the candidates: of a single model, it and all its sub-models.
Result<std::vector<Model>> candidates_of(const std::vector<FullModel>& named,
                                         const std::vector<WaveletVariance>& measured) {
  std::vector<Model> out;
  for (const FullModel& one : named) {
    if (auto enough = enough_scales(one.noise, measured); !enough)
      return tl::unexpected(enough.error());
    out.push_back(one.noise);
  }
  return out.size() == 1 ? sub_models(out.front()) : out;
}

v1::ChoiceVerdict verdict_of(ChoiceVerdict from) {
  switch (from) {
    case ChoiceVerdict::kSelected:
      return v1::selected;
    case ChoiceVerdict::kEquivalent:
      return v1::equivalent;
    case ChoiceVerdict::kNotAppropriate:
      break;
  }
  return v1::not_appropriate;
}

void add_candidate(const Candidate& from, const std::vector<EffectTerm>& effects,
                   v1::ChoiceReport& out) {
  v1::CandidateModel& to = *out.add_candidates();
  to.set_model(model_text(from.model, effects));
  to.set_fitted_model(print_with_values(FullModel{from.model, effects}));
  to.set_parameters(static_cast<std::uint32_t>(free_parameters(from.model)));
  to.set_merit(from.merit.value);
  to.set_merit_lower(from.merit.lower);
  to.set_merit_upper(from.merit.upper);
  to.set_excess(from.excess.value);
  to.set_excess_lower(from.excess.lower);
  to.set_excess_upper(from.excess.upper);
  to.set_verdict(verdict_of(from.verdict));
}

const v1::CandidateModel& simplest_equivalent(const v1::ChoiceReport& report) {
  const v1::CandidateModel* simplest = &report.candidates(0);
  for (const v1::CandidateModel& one : report.candidates()) {
    if (one.verdict() == v1::equivalent && one.parameters() < simplest->parameters()) {
      simplest = &one;
    }
  }
  return *simplest;
}

std::string summary_of(const v1::ChoiceReport& report) {
  const v1::CandidateModel& best = report.candidates(0);
  std::string out = fmt::format(
      "{} has the smallest held-out error: {:.3g} times the noise "
      "floor.",
      best.model(), best.merit());
  if (const v1::CandidateModel& simplest = simplest_equivalent(report); &simplest != &best) {
    out +=
        fmt::format(" {} is simpler, and the data do not show that it is worse.", simplest.model());
  }
  if (report.far_from_floor()) {
    out +=
        " That is far from the floor: either every model lacks a process, or the replicates differ "
        "significantly; imunoise test shows which.";
  }
  return out;
}

}  // namespace

Result<v1::ChoiceReport> select_model(const Series& given, const SelectOptions& options,
                                      const Progress& progress) {
  const bool blocks = given.replicates.size() == 1;
  if (blocks && given.replicates.front().size() < kBlocks * kLeastSamples) {
    return fail(fmt::format(
        "{}: one recording of {} samples is too short to be cut into {} blocks of {}: record more "
        "replicates, or longer",
        given.channel, given.replicates.front().size(), kBlocks, kLeastSamples));
  }
  if (options.choice.splits == Splits::kHalf && given.replicates.size() > kMostForHalves) {
    return fail(
        fmt::format("{}: {} replicates have too many splits into halves; leave out one at a "
                    "time (--splits leave-one-out)",
                    given.channel, given.replicates.size()));
  }
  std::vector<std::string> texts = options.models;
  if (texts.empty()) texts.emplace_back(kDefaultModel);
  auto named = read_models(texts, given.replicates.front().rate());
  if (!named) return tl::unexpected(named.error());
  const auto left = take_out_effects(given, largest(*named), progress.part(0.0, 0.3));
  if (!left) return tl::unexpected(left.error());
  const Series series = blocks ? in_blocks(left->series) : left->series;
  const auto measured = measured_replicates(series, options.measure, progress.part(0.3, 0.5));
  if (!measured) return tl::unexpected(measured.error());
  const auto candidates = candidates_of(*named, *measured);
  if (!candidates) return tl::unexpected(candidates.error());
  const ModelChoice choice =
      choose_model(*candidates, *measured, options.choice, progress.part(0.5, 1.0));
  if (progress.stopped()) return fail("stopped");

  v1::ChoiceReport out;
  out.set_channel(series.channel);
  out.set_unit(std::string(si_symbol(measured->front().quantity)));
  out.set_rate_hz(series.replicates.front().rate().value);
  out.set_replicates(static_cast<std::uint32_t>(series.replicates.size()));
  out.set_contiguous_blocks(blocks);
  out.set_splits(options.choice.splits == Splits::kHalf ? "half" : "leave one out");
  out.set_split_count(static_cast<std::uint32_t>(choice.splits));
  out.set_estimator(moments_estimator(series.replicates.size()));
  out.set_weights(options.choice.weighting == Weighting::kFull ? "full" : "diag");
  for (const Candidate& candidate : choice.candidates) add_candidate(candidate, left->effects, out);
  for (const v1::FittedEffect& one : left->numbers) *out.add_effects() = one;
  if (!left->effects.empty()) out.add_notes(taken_out_note(*left));
  const v1::CandidateModel& best = out.candidates(0);
  out.set_far_from_floor(best.merit() > kFarFromFloor && best.merit_lower() > 1.0);
  out.set_summary(summary_of(out));
  if (blocks) {
    out.add_notes(
        fmt::format("There is one recording; imunoise cut it into {} contiguous blocks. They do "
                    "not show changes "
                    "from day to day or between power-ons, so this is weaker evidence than "
                    "replicates.",
                    kBlocks));
  }
  if (series.replicates.size() < kFewReplicates) {
    out.add_notes(fmt::format(
        "{} replicates hardly show which model is better: the intervals are wide. Record at "
        "least 6.",
        series.replicates.size()));
  }
  if (options.models.empty()) {
    out.add_notes(default_model_note("and its sub-models were compared"));
  }
  return out;
}

const v1::CandidateModel& model_to_use(const v1::ChoiceReport& choice) {
  return choice.far_from_floor() ? choice.candidates(0) : simplest_equivalent(choice);
}

}  // namespace imunoise::study
