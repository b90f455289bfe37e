#include "study/analysis/select_model.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "core/effects/parse_full_model.h"
#include "core/spectrum/cross_power.h"
#include "study/analysis/compared_models.h"
#include "study/analysis/prepare.h"
#include "study/analysis/vocabulary.h"
#include "study/words/number.h"

namespace imunoise::study {
namespace {

constexpr std::size_t kBlocks = 6;            // of a single recording, and parts of its bands
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

// Whether the spectrum of a process is straight over any narrow band.
bool is_straight(const Process& process) {
  return std::holds_alternative<WhiteNoise>(process) ||
         std::holds_alternative<QuantisationNoise>(process) ||
         std::holds_alternative<RandomWalk>(process) || std::holds_alternative<RateRamp>(process) ||
         std::holds_alternative<Ar1>(process) || std::holds_alternative<GaussMarkov>(process) ||
         std::holds_alternative<Flicker>(process) || std::holds_alternative<PowerLaw>(process);
}

bool are_straight(const std::vector<FullModel>& models) {
  return std::all_of(models.begin(), models.end(), [](const FullModel& one) {
    return std::all_of(one.noise.terms.begin(), one.noise.terms.end(),
                       [](const Term& term) { return is_straight(term.process); });
  });
}

// What is held out of the likelihood, one at a time: replicates, or of a single one every sixth
// band. Empty where a replicate is too short for a likelihood.
std::vector<BandedPower> parts_of(const Series& series, bool straight) {
  std::vector<BandedPower> out;
  for (const Signal& one : series.replicates) {
    if (one.size() < kFewestSamples) return {};
    out.push_back(banded_power(one));
    if (straight) out.back() = in_wider_bands(out.back());
  }
  return out.size() == 1 ? dealt_out(out.front(), kBlocks) : out;
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

Result<void> all_have_scales(const std::vector<FullModel>& named,
                             const std::vector<WaveletVariance>& measured) {
  for (const FullModel& one : named) {
    if (auto sound = can_be_fitted(one.noise, measured); !sound) return sound;
  }
  return {};
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
  std::string out;
  if (!report.chosen().empty()) {
    out = fmt::format(
        "{} is chosen: no model with fewer parameters comes within {:g} nats of the best held-out "
        "likelihood. By CV-WVIC, ",
        report.chosen(), kClearNats);
  }
  out += fmt::format("{} has the smallest held-out error: {} times the noise floor.", best.model(),
                     report::brief(best.merit()));
  const v1::CandidateModel& simplest = simplest_equivalent(report);
  if (report.chosen().empty() && &simplest != &best) {
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

// What the held-out likelihood says of each candidate; `place` is that of a candidate among them.
void add_likelihoods(const std::vector<HeldOutFit>& held, const std::vector<std::size_t>& place,
                     v1::ChoiceReport& out) {
  const HeldOutFit& best = *std::max_element(
      held.begin(), held.end(), [](const auto& a, const auto& b) { return a.total() < b.total(); });
  const std::size_t chosen = simplest_of_best(held);
  for (int i = 0; i < out.candidates_size(); ++i) {
    const std::size_t at = place[static_cast<std::size_t>(i)];
    const HeldOutFit& own = held[at];
    v1::CandidateModel& to = *out.mutable_candidates(i);
    if (at == chosen) out.set_chosen(to.model());
    if (!std::isfinite(own.total())) continue;
    to.set_shortfall(best.total() - own.total());
    std::uint32_t worse = 0;
    for (std::size_t k = 0; k < own.nats.size(); ++k) worse += own.nats[k] < best.nats[k] ? 1U : 0U;
    to.set_replicates_worse(worse);
  }
}

struct Compared {
  LessEffects left;
  bool blocks = false;  // of a single recording
  Series series;        // replicates, or blocks
  Comparisons candidates;
};

Result<Compared> compare(const Series& given, const SelectOptions& options,
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
  auto left = take_out_effects(given, largest(*named), progress.part(0.0, 0.3));
  if (!left) return tl::unexpected(left.error());
  Series series = blocks ? in_blocks(left->series) : left->series;
  auto measured = measured_replicates(series, options.measure, progress.part(0.3, 0.5));
  if (!measured) return tl::unexpected(measured.error());
  if (auto enough = all_have_scales(*named, *measured); !enough)
    return tl::unexpected(enough.error());
  Comparisons candidates(std::move(*measured), parts_of(left->series, are_straight(*named)));
  std::vector<Model> models;
  for (const FullModel& one : *named) models.push_back(one.noise);
  candidates.add(models.size() == 1 ? sub_models(models.front()) : models, progress.part(0.5, 0.8));
  if (options.search_on || options.models.empty()) candidates.search_on(progress.part(0.8, 1.0));
  if (progress.stopped()) return fail("stopped");
  return Compared{std::move(*left), blocks, std::move(series), std::move(candidates)};
}

Result<v1::ChoiceReport> choice_report(const Compared& compared, const SelectOptions& options,
                                       const Progress& progress) {
  const auto& [left, blocks, series, candidates] = compared;
  const std::vector<WaveletVariance>& measured = candidates.measured();
  const ModelChoice choice = choose_model(candidates.models(), measured, options.choice, progress);
  if (progress.stopped()) return fail("stopped");

  v1::ChoiceReport out;
  out.set_channel(series.channel);
  out.set_unit(std::string(si_symbol(measured.front().quantity)));
  out.set_rate_hz(series.replicates.front().rate().value);
  out.set_replicates(static_cast<std::uint32_t>(series.replicates.size()));
  out.set_contiguous_blocks(blocks);
  out.set_splits(options.choice.splits == Splits::kHalf ? "half" : "leave one out");
  out.set_split_count(static_cast<std::uint32_t>(choice.splits));
  out.set_estimator(moments_estimator(series.replicates.size()));
  out.set_weights(options.choice.weighting == Weighting::kFull ? "full" : "diag");
  std::vector<std::size_t> place;
  for (const Candidate& candidate : choice.candidates) {
    add_candidate(candidate, left.effects, out);
    place.push_back(candidate.place);
  }
  if (!candidates.held().empty()) add_likelihoods(candidates.held(), place, out);
  for (const v1::FittedEffect& one : left.numbers) *out.add_effects() = one;
  if (!left.effects.empty()) out.add_notes(taken_out_note(left));
  const v1::CandidateModel& best = out.candidates(0);
  out.set_far_from_floor(best.merit() > kFarFromFloor && best.merit_lower() > 1.0);
  out.set_summary(summary_of(out));
  if (blocks) {
    out.add_notes(
        fmt::format("There is one recording; imunoise cut it into {} contiguous blocks. They do "
                    "not show changes "
                    "from day to day or between power-ons, so this is weaker evidence than "
                    "replicates. The held-out likelihood leaves out a sixth of the frequencies at "
                    "a time instead.",
                    kBlocks));
  }
  if (series.replicates.size() < kFewReplicates) {
    out.add_notes(fmt::format(
        "{} replicates hardly show which model is better: the intervals are wide. Record at "
        "least 6.",
        series.replicates.size()));
  }
  if (options.models.empty()) {
    out.add_notes(default_model_note(
        "and its sub-models were compared, and from the best of them on FN, QN and DR"));
  }
  const std::string& used = model_to_use(out).model();
  for (const Candidate& one : choice.candidates) {
    if (model_text(one.model, left.effects) != used) continue;
    if (auto note = quantisation_note(one.model)) out.add_notes(std::move(*note));
  }
  return out;
}

}  // namespace

Result<v1::ChoiceReport> select_model(const Series& series, const SelectOptions& options,
                                      const Progress& progress) {
  const auto compared = compare(series, options, progress.part(0.0, 0.6));
  if (!compared) return tl::unexpected(compared.error());
  return choice_report(*compared, options, progress.part(0.6, 1.0));
}

Result<std::string> chosen_model(const Series& series, const SelectOptions& options,
                                 const Progress& progress) {
  const auto compared = compare(series, options, progress);
  if (!compared) return tl::unexpected(compared.error());
  if (!compared->candidates.held().empty())
    return model_text(compared->candidates.best().model, compared->left.effects);
  const auto choice = choice_report(*compared, options, progress);
  if (!choice) return tl::unexpected(choice.error());
  return model_to_use(*choice).model();
}

const v1::CandidateModel& model_to_use(const v1::ChoiceReport& choice) {
  for (const v1::CandidateModel& one : choice.candidates()) {
    if (one.model() == choice.chosen()) return one;
  }
  return choice.far_from_floor() ? choice.candidates(0) : simplest_equivalent(choice);
}

}  // namespace imunoise::study
