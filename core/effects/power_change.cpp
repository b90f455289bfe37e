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

Eigen::ArrayXd inside(const EffectTerm& term, const Subject& subject, std::size_t k) {
  const auto [begin, end] = samples_of(term, subject, k);
  Eigen::ArrayXd out = Eigen::ArrayXd::Zero(subject.length(k));
  out.segment(begin, end - begin) = 1.0;
  return out;
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
  double ratio = 1.0;  // of the power within to that outside
  double error = 0.0;  // standard error of its logarithm
};

// Samples of a replicate, 1 where they belong.
using Samples = Eigen::ArrayXd;

ChangedPower compared(const Eigen::VectorXd& white, const Samples& inside, const Samples& outside) {
  const auto power = [&](const Samples& of) {
    return (white.array().square() * of).sum() / of.sum();
  };
  ChangedPower out;
  out.ratio = power(inside) / power(outside);
  out.error = std::sqrt(2.0 / inside.sum() + 2.0 / outside.sum());
  return out;
}

struct Change {
  EffectTerm term;
  Samples inside;
};

// The other changes that a model has in the same replicate.
std::vector<Change> others_beside(const EffectTerm& term, const Current& current) {
  const Subject& subject = current.subject();
  const std::size_t changed = *changing(term, subject);
  std::vector<Change> out;
  for (const EffectTerm& other : current.regression.effects()) {
    if (other.effect == &power_change() && !(other == term) && changing(other, subject) == changed)
      out.push_back({other, inside(other, subject, changed)});
  }
  return out;
}

// Its power is compared with that outside all changes. Those that were found before were compared
// with samples that belong to this one: they are found anew.
std::shared_ptr<const Subject> of_one_power(const EffectTerm& term, const Current& current) {
  const Subject& subject = current.subject();
  const std::size_t changed = *changing(term, subject);
  const Samples own = inside(term, subject, changed);
  const std::vector<Change> others = others_beside(term, current);
  Samples outside = 1.0 - own;
  for (const Change& other : others) outside *= 1.0 - other.inside;
  if (outside.sum() < static_cast<double>(kFewest)) outside = 1.0 - own;
  std::vector<std::shared_ptr<ChangedPower>> anew(others.size());
  auto found = std::make_shared<ChangedPower>();
  auto out = reshaped(current, [&](const Eigen::VectorXd& white, std::size_t k) {
    Reshaping how{Samples::Ones(white.size())};
    if (k != changed) return how;
    const auto divide = [&](const Samples& where, double ratio) {
      how.factor *= 1.0 + where * (1.0 / std::sqrt(ratio) - 1.0);
    };
    for (std::size_t i = 0; i < others.size(); ++i) {
      const auto* const before = subject.found_by<ChangedPower>(others[i].term);
      const Samples alone = others[i].inside * (1.0 - own);
      if (before == nullptr || alone.sum() < static_cast<double>(kFewest)) continue;
      anew[i] = std::make_shared<ChangedPower>(compared(white, alone, outside));
      divide(others[i].inside, anew[i]->ratio);
      anew[i]->ratio *= before->ratio;
    }
    *found = compared((white.array() * how.factor).matrix(), own, outside);
    divide(own, found->ratio);
    return how;
  });
  constexpr double kCoefficients = 3.0;  // a ratio and two times
  out->own_nats.resize(out->replicates(), 0.0);
  out->own_nats[changed] += kCoefficients;
  for (std::size_t i = 0; i < others.size(); ++i) {
    if (anew[i]) out->keep(others[i].term, std::move(anew[i]));
  }
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

// A part of a replicate whose power is not that of the other replicates: what was found, or else
// what lies beside it; of two parts that make a single replicate the shorter one.
PowerSpell unusual(const PowerSpell& spell, std::size_t place, const Innovations& all) {
  const Eigen::VectorXd& white = all.white[place];
  const bool between = spell.begin > 0 && spell.end < white.size();
  if (between && all.white.size() == 1) return spell;
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
  const PowerSpell beside = best_beside(white, spell);
  return beside.size() > 0 ? beside : spell;
}

// A third is no event: the power wanders.
constexpr std::ptrdiff_t kMostEvents = 2;

std::ptrdiff_t events_in(const Current& current) {
  const auto& effects = current.regression.effects();
  return std::count_if(effects.begin(), effects.end(),
                       [](const EffectTerm& term) { return term.effect == &power_change(); });
}

// The best of all replicates, and in which of the innovations.
struct PlacedSpell {
  std::size_t place = 0;
  PowerSpell spell;
};

PlacedSpell best_of(const Innovations& all) {
  std::vector<PowerSpell> each(all.white.size());
  for_each_index(each.size(), [&](std::size_t i) { each[i] = best_spell(all.white[i]); });
  PlacedSpell out;
  for (std::size_t i = 0; i < each.size(); ++i) {
    if (each[i].nats > out.spell.nats) out = {i, each[i]};
  }
  return out;
}

double log_places(const Innovations& all) {
  return std::log(kSpells * static_cast<double>(all.white.size()));
}

EffectTerm term_of(const PowerSpell& spell, const Part& part, Hertz rate) {
  const auto seconds = [&](Index sample) {
    return static_cast<double>(part.first + sample) / rate.value;
  };
  return EffectTerm(power_change(), "",
                    {{"replicate", static_cast<double>(part.recorded + 1)},
                     {"from", seconds(spell.begin)},
                     {"to", seconds(spell.end)}});
}

Suggestions search_power_change(const SearchView& view) {
  const Innovations& all = view.innovations();
  const Subject& subject = view.subject();
  Suggestion out{.cause = "power_change",
                 .added = EffectTerm(power_change()),
                 .search = {.log_places = log_places(all)}};
  if (events_in(view.current()) >= kMostEvents) return {out};
  const auto [place, found] = best_of(all);
  if (!(found.nats > out.search.log_places)) return {out};
  const PowerSpell best = without_gap(all.white[place], unusual(found, place, all));
  out.added = term_of(best, subject.parts[all.replicates[place]], subject.rate);
  out.inflation = inflation_of(view, best, place);
  out.score_nats = best.nats / out.inflation;
  return {out};
}

// The next event beside the first, and the nats that it gains beyond chance.
struct NextEvent {
  FittedModel model;
  double nats;
};

std::optional<NextEvent> next_beside(const FittedModel& first) {
  const Innovations left = innovations(first.regression, first.fit);
  const auto [place, next] = best_of(left);
  const Eigen::VectorXd& white = left.white[place];
  constexpr double kSurely = 5.0;  // nats
  const double within = next.nats / excess_scatter(white, next);
  if (!(within > log_places(left) + kSurely && sharpness(white, next) > 0.0)) return std::nullopt;
  const Subject& subject = first.regression.subject();
  const EffectTerm term = term_of(next, subject.parts[left.replicates[place]], subject.rate);
  if (!check_power_change(term, subject)) return std::nullopt;
  FittedModel both = fit_with(current_of(first.regression, first.fit), term);
  const double gain = both.fit.log_likelihood - first.fit.log_likelihood;
  return NextEvent{std::move(both), std::max(gain, within) - log_places(left)};
}

// Where it is one rise of many, or a slow one, the power may wander.
void review_power_change(const Current& current, TriedTerm& tried) {
  tried.against_wander = true;
  // The replicate itself is the evidence. Once it is, what the others say counts, too, unless they
  // differ anyway.
  Suggestion& found = tried.suggestion;
  const double within = found.score_nats * found.inflation;
  tried.likelihood_gain =
      worsens_tails(current, tried.fitted) ? 0.0 : std::max(tried.likelihood_gain, within);
  found.inflation = std::max(found.inflation, tried.likelihood_gain / found.score_nats);
  const Subject& subject = current.subject();
  const std::size_t changed = *changing(*tried.term(), subject);
  const auto [begin, end] = samples_of(*tried.term(), subject, changed);
  const Innovations before = innovations(current.regression, current.fit);
  const auto at = std::find(before.replicates.begin(), before.replicates.end(), changed);
  const Eigen::VectorXd& white =
      before.white[static_cast<std::size_t>(at - before.replicates.begin())];
  std::optional<NextEvent> next;
  if (events_in(current) + 1 < kMostEvents) next = next_beside(tried.fitted);
  if (next) tried.next_gain = next->nats;
  const FittedModel& all = next ? next->model : tried.fitted;
  const auto power = PowerView::of(innovations(all.regression, all.fit));
  constexpr double kSurely = 3.0;   // nats
  constexpr double kClearly = 8.0;  // nats
  if ((power && power->wander_gain() > kSurely) ||
      !(sharpness(white, power_spell(white, begin, end)) > kClearly))
    tried.could_be.push_back("variance_wander");
}

std::vector<ReportedNumber> power_change_numbers(const FittedEffect& effect) {
  const auto* const found = effect.subject().found_by<ChangedPower>(effect.term());
  if (found == nullptr) return {};
  return {with_log_error({"ratio", found->ratio, "1"}, found->error)};
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
                      "the same again, with notes of what goes on nearby; if you know what "
                      "happened then, keep the term",
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
