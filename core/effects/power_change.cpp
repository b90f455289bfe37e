// power_change: for a while, the noise of one replicate has another power.

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "core/effect/columns.h"
#include "core/effects/distributions/power_spell.h"
#include "core/effects/reshaped_noise.h"
#include "core/search/search_view.h"
#include "core/support/parallel.h"

namespace imunoise::effects {

const Effect& power_change();

namespace {

using Index = Eigen::Index;

enum PowerChangeParameter : std::size_t {
  kPowerChangeReplicate,
  kPowerChangeFrom,
  kPowerChangeTo,
  kPowerChangeRatio
};

std::size_t replicate_of(const EffectTerm& term) {
  return static_cast<std::size_t>(term[kPowerChangeReplicate]) - 1;
}

// The replicate whose noise changes: the one around its middle.
std::optional<std::size_t> changing(const EffectTerm& term, const Subject& subject) {
  const double middle = 0.5 * (term[kPowerChangeFrom] + term[kPowerChangeTo]);
  return subject.around(replicate_of(term), std::lround(middle * subject.rate.value));
}

// From its first sample to that after its last.
std::pair<Index, Index> samples_of(const EffectTerm& term, const Subject& subject, std::size_t k) {
  const auto place = [&](double seconds) {
    return std::clamp<Index>(std::lround(seconds * subject.rate.value) - subject.parts[k].first, 0,
                             subject.length(k));
  };
  return {place(term[kPowerChangeFrom]), place(term[kPowerChangeTo])};
}

std::string_view power_change_fault(const EffectTerm& term) {
  return term[kPowerChangeFrom] < term[kPowerChangeTo] ? "" : "from must lie below to";
}

constexpr Index kFewest = 16;  // samples within, and outside

Result<void> check_power_change(const EffectTerm& term, const Subject& subject) {
  const std::size_t recorded = subject.parts.back().recorded + 1;
  if (term[kPowerChangeReplicate] > static_cast<double>(recorded))
    return unfit(term, fmt::format("there are only {} replicates", recorded));
  const auto k = changing(term, subject);
  if (!k) return unfit(term, "the replicate has no usable samples at that time");
  const auto [begin, end] = samples_of(term, subject, *k);
  if (end - begin < kFewest || subject.length(*k) - (end - begin) < kFewest)
    return unfit(term, fmt::format("{} samples at least must lie within, and outside", kFewest));
  return {};
}

// What a fit found of it.
struct ChangedPower : Found {
  PowerSpell spell;
};

std::shared_ptr<const Subject> of_one_power(const EffectTerm& term, const Current& current) {
  const std::size_t changed = *changing(term, current.subject());
  const auto [begin, end] = samples_of(term, current.subject(), changed);
  auto found = std::make_shared<ChangedPower>();
  auto out =
      reshaped(current, [&, from = begin, to = end](const Eigen::VectorXd& white, std::size_t k) {
        Reshaping how{Eigen::ArrayXd::Ones(white.size())};
        if (k != changed) return how;
        found->spell = power_spell(white, from, to);
        how.factor.segment(from, to - from) = 1.0 / std::sqrt(found->spell.ratio);
        how.nats = found->spell.nats;
        return how;
      });
  constexpr double kCoefficients = 3.0;  // a ratio and two times
  out->own_nats.resize(out->replicates(), 0.0);
  out->own_nats[changed] += kCoefficients;
  out->keep(term, std::move(found));
  return out;
}

void simulate_power_change(const EffectTerm& term, const SimulatedReplicate& at,
                           Eigen::VectorXd& samples) {
  if (at.beside.parts[at.replicate].recorded != replicate_of(term)) return;
  const auto [begin, end] = samples_of(term, at.beside, at.replicate);
  samples.segment(begin, end - begin) *= std::sqrt(term[kPowerChangeRatio]);
}

VarianceCourse course_in(const PowerSpell& spell, std::size_t in, const Subject& subject) {
  VarianceCourse out;
  for (std::size_t k = 0; k < subject.replicates(); ++k)
    out.samples.emplace_back(k == in ? course_of(spell, subject.length(k), 0.0)
                                     : Eigen::VectorXd::Zero(subject.length(k)));
  return out;
}

// What it gains by chance, against normal noise of constant power: heavy tails scatter squares, and
// where the power wanders by itself, some stretch stands out.
double inflation_of(const SearchView& view, const PowerSpell& best, std::size_t place) {
  const Innovations& all = view.innovations();
  double out = excess_scatter(all.white[place], best);
  if (view.power() == nullptr) return out;
  const PowerView::Explained explained =
      view.power()->explained(course_in(best, all.replicates[place], view.subject()));
  constexpr double kLeast = 1e-3;  // nats
  if (!explained.steady && explained.gain < best.nats)
    out = std::max(out, best.nats / std::max(kLeast, explained.gain));
  return out;
}

// Of two parts that make a replicate, the one whose power is not that of the other replicates; of a
// single replicate the shorter one.
PowerSpell unusual(const PowerSpell& spell, std::size_t place, const Innovations& all) {
  const Eigen::VectorXd& white = all.white[place];
  if (spell.begin > 0 && spell.end < white.size()) return spell;
  double squares = 0.0;
  double samples = 0.0;
  for (std::size_t i = 0; i < all.white.size(); ++i) {
    if (i == place) continue;
    squares += all.white[i].squaredNorm();
    samples += static_cast<double>(all.white[i].size());
  }
  const auto inside = static_cast<double>(spell.size());
  const auto outside = static_cast<double>(white.size()) - inside;
  const double within = white.segment(spell.begin, spell.size()).squaredNorm();
  const double in = within / inside;
  const double out = (white.squaredNorm() - within) / outside;
  const double usual = squares / samples;
  const bool as_usual = samples > 0.0
                            ? std::abs(std::log(in / usual)) < std::abs(std::log(out / usual))
                            : inside > outside;
  if (!as_usual) return spell;
  return spell.begin == 0 ? power_spell(white, spell.end, white.size())
                          : power_spell(white, 0, spell.begin);
}

Suggestions search_power_change(const SearchView& view) {
  const Innovations& all = view.innovations();
  const Subject& subject = view.subject();
  std::vector<PowerSpell> each(all.white.size());
  for_each_index(each.size(), [&](std::size_t i) { each[i] = best_spell(all.white[i]); });
  const auto found = std::max_element(
      each.begin(), each.end(),
      [](const PowerSpell& one, const PowerSpell& other) { return one.nats < other.nats; });
  Suggestion out{.cause = "power_change",
                 .added = EffectTerm(power_change()),
                 .search = {.log_places = std::log(kSpells * static_cast<double>(each.size()))}};
  // A third is no event: the power wanders.
  constexpr std::ptrdiff_t kMostEvents = 2;
  const auto& effects = view.current().regression.effects();
  const auto events = std::count_if(effects.begin(), effects.end(), [](const EffectTerm& term) {
    return term.effect == &power_change();
  });
  if (events >= kMostEvents) return {out};
  if (found == each.end() || !(found->nats > out.search.log_places)) return {out};
  const auto place = static_cast<std::size_t>(found - each.begin());
  const PowerSpell best = unusual(*found, place, all);
  const Part& part = subject.parts[all.replicates[place]];
  const auto seconds = [&](Index sample) {
    return static_cast<double>(part.first + sample) / subject.rate.value;
  };
  out.added = EffectTerm(power_change(), "",
                         {{"replicate", static_cast<double>(part.recorded + 1)},
                          {"from", seconds(best.begin)},
                          {"to", seconds(best.end)}});
  out.inflation = inflation_of(view, best, place);
  out.score_nats = best.nats / out.inflation;
  return {out};
}

// Where it is one rise of many, or a slow one, the power may wander.
void review_power_change(const Current& current, TriedTerm& tried) {
  if (worsens_tails(current, tried.fitted)) tried.likelihood_gain = 0.0;
  tried.against_wander = true;
  const Suggestion& found = tried.suggestion;
  tried.likelihood_gain = std::min(tried.likelihood_gain, found.score_nats * found.inflation);
  const Subject& subject = current.subject();
  const std::size_t changed = *changing(*tried.term(), subject);
  const auto [begin, end] = samples_of(*tried.term(), subject, changed);
  const Innovations before = innovations(current.regression, current.fit);
  const auto at = std::find(before.replicates.begin(), before.replicates.end(), changed);
  const Eigen::VectorXd& white =
      before.white[static_cast<std::size_t>(at - before.replicates.begin())];
  const auto left =
      PowerView::of(innovations(tried.fitted.regression, tried.fitted.fit), subject.rate);
  constexpr double kSurely = 3.0;  // nats
  if ((left && left->wander_gain() > kSurely) ||
      !changes_at_once(white, power_spell(white, begin, end)))
    tried.could_be.push_back("variance_wander");
}

std::vector<ReportedNumber> power_change_numbers(const FittedEffect& effect) {
  const auto* const found = effect.subject().found_by<ChangedPower>(effect.term());
  if (found == nullptr) return {};
  return {with_log_error({"ratio", found->spell.ratio, "1"}, found->spell.error)};
}

void power_change_more(const TriedTerm& tried, std::vector<ReportedNumber>& first,
                       std::vector<ReportedNumber>&) {
  first.push_back({"from_s", (*tried.term())[kPowerChangeFrom], "s"});
  first.push_back({"to_s", (*tried.term())[kPowerChangeTo], "s"});
  first.push_back({"replicate", (*tried.term())[kPowerChangeReplicate], "1"});
}

}  // namespace

const Effect& power_change() {
  static const Effect kPowerChange{
      .name = "power_change",
      .title = "noise of another power for a while",
      .meaning = "Gives the noise of one replicate another power between two times.",
      .parameters = {{.name = "replicate",
                      .meaning = "number of the replicate as recorded, counted from 1",
                      .form = ParameterForm::kWholeNumber,
                      .required = true,
                      .lower = 1.0},
                     {.name = "from",
                      .meaning = "where it begins, from the first sample of what was recorded; not "
                                 "given: there",
                      .unit = "s",
                      .rounding = Rounding::kBySample},
                     {.name = "to",
                      .meaning = "where it ends",
                      .unit = "s",
                      .required = true,
                      .rounding = Rounding::kBySample},
                     {.name = "ratio",
                      .meaning = "power there over that before and after",
                      .unit = "1",
                      .reported = "ratio",
                      .truth = true}},
      .coefficient = "ratio",
      .anywhere = true,
      .causes = {{.id = "power_change",
                  .title = "noise of another power for a while",
                  .physics = "A machine ran or people worked near the bench for a while, or the "
                             "sensor itself grew noisy, or changed its range or its filter.",
                  .record_next =
                      "nothing, if you know what happened then: keep the term; else the same "
                      "again, with notes of what goes on nearby",
                  .looks_like = {"variance_wander", "bursts", "replicate_change"},
                  .family = "power_change"}},
      .fault = power_change_fault,
      .check = check_power_change,
      .cleaned = of_one_power,
      .simulate = simulate_power_change,
      .search = search_power_change,
      .review = review_power_change,
      .numbers = power_change_numbers,
      .more_numbers = power_change_more,
  };
  return kPowerChange;
}

}  // namespace imunoise::effects
