#include "tests/hidden_effects/scoring/error_fall.h"

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <numeric>

#include "study/analysis/evaluate.h"
#include "tests/hidden_effects/generator/two_level_oracle.h"
#include "tests/hidden_effects/scoring/replicates.h"

namespace imunoise::hidden {
namespace {

double nats_of(const v1::Rung& rung) {
  return std::accumulate(rung.heldout_nats().begin(), rung.heldout_nats().end(), 0.0);
}

// Whether without it the data are what a perfect fit of it leaves. Others change spectra or
// variances.
bool shifts_the_mean(const HiddenEffect& effect) {
  static const std::vector<std::string> kShifts = {
      "line",     "harmonics",     "mains_alias", "rate_ramp",   "warm_up",
      "step",     "telegraph",     "tilt",        "temperature", "supply_voltage",
      "magnetic", "g_sensitivity", "cross_axis"};
  return std::find(kShifts.begin(), kShifts.end(), effect.id) != kShifts.end();
}

// A model of recordings, judged.
std::optional<v1::Rung> judged(const study::PreparedChannel& prepared, const std::string& model) {
  auto rung = study::evaluate(model, prepared, {.added = "", .why = ""});
  if (!rung || rung->heldout_nats_size() == 0) return std::nullopt;
  return std::move(*rung);
}

Result<study::RecordedChannel> looked(const std::vector<Recording>& recordings, double rate_hz) {
  auto replicates = to_replicates(recordings, rate_hz);
  const auto& channels = replicates.front().channels;
  const auto subject = std::find_if(channels.begin(), channels.end(),
                                    [](const auto& channel) { return channel.name == kSubject; });
  const auto place = static_cast<std::size_t>(subject - channels.begin());
  return study::prepare_channel(std::move(replicates), place, std::nullopt);
}

// Nats that telegraph noise costs an oracle who is not told when it jumps.
double price_of_courses(const HiddenCase& made) {
  const WhiteWalk noise{made.base.white, made.base.walk};
  const std::vector<TrueParameter>& truth = made.injections.front().parameters;
  const TwoLevelLaw law{truth[0].value, truth[1].value * made.rate_hz};
  double out = 0.0;
  for (std::size_t r = 0; r < made.recordings.size(); ++r) {
    RandomStream random(made.spec.seed, {static_cast<std::uint32_t>(r)});
    out += log_likelihood(made.clean[r][kSubject], noise) -
           log_likelihood(made.recordings[r][kSubject], noise, law, random);
  }
  return out;
}

// Held-out nats that an oracle gains; absent where the data without the effect tell nothing.
std::optional<double> oracle_gain(const Outcome& outcome, const HiddenCase& made, double before) {
  const Injection& put = outcome.injections.front();
  if (put.gained) return *put.gained;
  const double expected = 0.5 * put.delta * put.delta;
  const HiddenEffect& effect = *find_effect(outcome.spec.effects.front());
  if (!shifts_the_mean(effect)) return expected;
  const auto look = looked(made.clean, made.rate_hz);
  if (!look) return std::nullopt;
  const auto clean = judged(look->prepared, made.base.model);
  if (!clean) return std::nullopt;
  const double price = effect.id == "telegraph" ? price_of_courses(made)
                                                : 0.5 * put.informed * put.informed - expected;
  return nats_of(*clean) - before - price - put.untold;
}

// Of the tool's candidates, the first that has a right name.
const v1::EffectCandidate* true_candidate(const Outcome& outcome) {
  const std::vector<std::string> right = right_names(outcome.spec);
  for (const v1::EffectCandidate& one : outcome.report.candidates()) {
    if (std::find(right.begin(), right.end(), one.effect()) != right.end()) return &one;
  }
  return nullptr;
}

// A wave where there is none, and a channel that nothing follows.
std::vector<std::string> wrong_terms(const Outcome& outcome, double rate_hz) {
  constexpr double kGolden = 0.6180339887498949;
  const double part = std::fmod(kGolden * static_cast<double>(outcome.spec.seed), 1.0);
  char line[64];
  std::snprintf(line, sizeof line, "line(f=%.4f)", rate_hz * (0.1 + 0.35 * part));
  const HiddenEffect& effect = *find_effect(outcome.spec.effects.front());
  return {line, effect.witness == "supply" ? "witness(mag_x)" : "witness(supply)"};
}

// Whether a failing view, within its limit or not, is as good as that of the same noise without the
// effect under the true model.
bool as_clean(const HiddenCase& made, const v1::Rung& after, const ErrorFall& fall) {
  constexpr double kAlike = 1.1;
  const auto value = [&](const v1::Rung& rung) {
    const auto found = std::find_if(rung.views().begin(), rung.views().end(),
                                    [&](const auto& one) { return one.view() == fall.failing; });
    return found == rung.views().end() ? 0.0 : found->value() / found->chance_limit();
  };
  const auto look = looked(made.clean, made.rate_hz);
  if (!look) return false;
  const auto clean = judged(look->prepared, made.base.model);
  return clean && value(after) <= kAlike * value(*clean);
}

void compare_views(const v1::Rung& before, const v1::Rung& after, ErrorFall& out) {
  const v1::ErrorView* failing = nullptr;
  const auto excess = [](const v1::ErrorView& one) { return one.value() / one.chance_limit(); };
  for (const v1::ErrorView& one : before.views()) {
    constexpr double kFails = 1e-3;
    if (one.p() < kFails && (failing == nullptr || excess(one) > excess(*failing))) failing = &one;
  }
  for (const v1::ErrorView& now : after.views()) {
    const auto was = std::find_if(before.views().begin(), before.views().end(),
                                  [&](const auto& one) { return one.view() == now.view(); });
    if (failing != nullptr && failing->view() == now.view()) {
      out.failing = now.view();
      out.at_floor = now.value() <= now.chance_limit();
    } else if (was != before.views().end() && now.value() > now.chance_limit()) {
      constexpr double kNoise = 1.1;  // a limit is crossed by a hair
      if (now.value() > kNoise * std::max(was->value(), now.chance_limit())) out.risen = now.view();
    }
  }
}

}  // namespace

std::optional<ErrorFall> error_fall(const Outcome& outcome) {
  if (outcome.report.ladder_size() == 0) return std::nullopt;
  const v1::Rung& before = outcome.report.ladder(0);
  if (before.heldout_nats_size() == 0) return std::nullopt;
  const HiddenCase made = make_case(outcome.spec);
  const auto look = looked(made.recordings, made.rate_hz);
  if (!look) return std::nullopt;
  const study::PreparedChannel& prepared = look->prepared;
  const auto oracle = oracle_gain(outcome, made, nats_of(before));
  if (!oracle) return std::nullopt;
  ErrorFall out{.oracle = *oracle};
  const v1::EffectCandidate* const added = true_candidate(outcome);
  if (added == nullptr) return out;
  std::optional<v1::Rung> after;
  if (outcome.named(1) && outcome.report.ladder_size() > 1) {
    after = outcome.report.ladder(1);
  } else {
    after = judged(prepared, before.model() + " + " + added->term());
  }
  if (!after || after->heldout_nats_size() == 0) return std::nullopt;
  out.offered = true;
  out.share = (nats_of(*after) - nats_of(before)) / *oracle;
  compare_views(before, *after, out);
  out.as_clean = out.at_floor || (!out.failing.empty() && as_clean(made, *after, out));
  const auto again = judged(prepared, after->model());
  for (const std::string& term : wrong_terms(outcome, made.rate_hz)) {
    const auto wrong = judged(prepared, after->model() + " + " + term);
    if (wrong && again) out.wrong.push_back({term, nats_of(*wrong) - nats_of(*again)});
  }
  return out;
}

void FallScore::add(const ErrorFall& fall) {
  enough.add(fall.enough());
  if (fall.can_be_found()) found.add(fall.enough());
  if (!fall.offered) return;
  shares.push_back(fall.share);
  if (!fall.failing.empty()) at_floor.add(fall.at_floor);
  if (!fall.failing.empty()) as_clean.add(fall.as_clean);
  risen.add(!fall.risen.empty());
  for (const WrongTerm& one : fall.wrong) wrong.add(one.beyond_chance());
}

void FallScore::add(const FallScore& other) {
  enough.add(other.enough);
  found.add(other.found);
  at_floor.add(other.at_floor);
  as_clean.add(other.as_clean);
  risen.add(other.risen);
  wrong.add(other.wrong);
  shares.insert(shares.end(), other.shares.begin(), other.shares.end());
}

std::string describe(const Outcome& outcome, const ErrorFall& fall) {
  char share[64];
  std::snprintf(share, sizeof share, ": falls by %.0f %% of %.0f nats", 100.0 * fall.share,
                fall.oracle);
  if (!fall.offered) return outcome.describe() + share + ": the true effect is not offered";
  std::string out = outcome.describe() + share;
  if (!fall.failing.empty())
    out += ", " + fall.failing +
           (fall.at_floor   ? " at its floor"
            : fall.as_clean ? " above its floor, as without the effect"
                            : " above its floor");
  if (!fall.risen.empty()) out += ", " + fall.risen + " rose";
  for (const WrongTerm& one : fall.wrong) {
    char gain[64];
    std::snprintf(gain, sizeof gain, " gains %.1f", one.gain);
    out += ", " + one.term + gain;
  }
  return out;
}

}  // namespace imunoise::hidden
