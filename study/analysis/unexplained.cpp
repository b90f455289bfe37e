#include "study/analysis/unexplained.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <numeric>
#include <vector>

#include "core/support/distributions.h"
#include "core/support/rough.h"
#include "study/analysis/sentences/error_sentences.h"

namespace imunoise::study {
namespace {

constexpr double kSignificant = 0.05;

// A rung among those that it is compared with.
struct Placed {
  v1::Rung* rung;
  const v1::Rung* parent = nullptr;  // what it was added to
  bool counts = true;                // a preview counts where its candidate is significant
  double promised = 0.0;             // nats that its candidates gain
};

double held_out_nats(const v1::Rung& rung) {
  return std::accumulate(rung.heldout_nats().begin(), rung.heldout_nats().end(), 0.0);
}

// Nats that a replicate gains, and its share of all samples.
struct Gain {
  double nats;
  double share;
};

// Of each replicate by which one rung lies above another; empty where they cannot be paired.
std::vector<Gain> gained(const v1::Rung& above, const v1::Rung& below) {
  std::vector<Gain> out;
  const int count = above.heldout_nats_size();
  if (count != below.heldout_nats_size()) return out;
  const bool alike = above.heldout_samples_size() != count;  // old files do not say
  const auto samples = [&](int k) {
    return alike ? 1.0 : static_cast<double>(above.heldout_samples(k));
  };
  double all = 0.0;
  for (int k = 0; k < count; ++k) all += samples(k);
  for (int k = 0; k < count; ++k)
    out.push_back({above.heldout_nats(k) - below.heldout_nats(k), samples(k) / all});
  return out;
}

double sum(const std::vector<Gain>& each) {
  double out = 0.0;
  for (const Gain& one : each) out += one.nats;
  return out;
}

// Half of the 95 % interval of a sum over replicates. Each contributes by its length: the scatter
// is that about its share of the sum (ratio estimator: Cochran 1977, Sampling Techniques, chapter
// 6).
double reach_of_sum(const std::vector<Gain>& each) {
  const auto n = static_cast<double>(each.size());
  const double all = sum(each);
  double squares = 0.0;
  for (const Gain& one : each)
    squares += (one.nats - one.share * all) * (one.nats - one.share * all);
  return student_quantile(0.975, n - 1.0) * std::sqrt(n * squares / (n - 1.0));
}

// A gain that one replicate has nearly alone says nothing about the next recording: no spread over
// replicates is its interval. The others then gain less than a fifth of what, by their length, they
// would if all were alike (as their noise is estimated better).
bool in_one_replicate(const std::vector<Gain>& each) {
  constexpr double kLittle = 0.2;
  constexpr double kWorthTelling = 5.0;  // nats
  if (each.size() < 3) return false;
  double all = 0.0;
  for (const Gain& one : each) all += std::abs(one.nats);
  const Gain most = *std::max_element(each.begin(), each.end(),
                                      [](const Gain& a, const Gain& b) { return a.nats < b.nats; });
  const auto n = static_cast<double>(each.size());
  return all > kWorthTelling &&
         all - most.nats < kLittle * all * (1.0 - most.share) * n / (n - 1.0);
}

std::string integral_name(const std::string& unit) {
  if (unit == "rad") return "angle";
  return unit == "m/s" ? "velocity" : "value";
}

// Of one view: "1.2 % off in the spectrum: ".
std::string size_in(const v1::ErrorView& view) {
  const std::string number = rough(view.value());
  if (view.view() == "averaging_times") return number + " % off in the Allan deviation: ";
  if (view.view() == "single_waves") return "A wave " + number + " dB over the noise: ";
  if (view.view() == "noise_over_time") return number + " % off in the power over time: ";
  if (view.view() == "distribution") return "Excess kurtosis " + number + ": ";
  if (view.view() == "witnesses") return "A witness explains " + number + " %: ";
  if (view.view() == "replicates") return number + " % off between replicates: ";
  return number + " % off in the spectrum: ";
}

// By the spectrum, or by the view that chance explains least where the spectrum shows nothing.
std::string size_of(const v1::Rung& rung) {
  const v1::ErrorView* spectrum = nullptr;
  const v1::ErrorView* surest = nullptr;
  for (const v1::ErrorView& one : rung.views()) {
    if (one.view() == "spectrum") spectrum = &one;
    if (surest == nullptr || one.p() < surest->p()) surest = &one;
  }
  if (spectrum == nullptr) return "";
  const bool elsewhere = spectrum->p() >= kSignificant && surest->p() < kSignificant;
  return size_in(elsewhere ? *surest : *spectrum);
}

// What a model says of the integrated error, against what the best says of it: where they differ
// most, empty where they agree. A filter believes what its model says.
std::string prediction_of(const v1::Rung& rung, const v1::Rung& best) {
  constexpr double kAlike = 1.1;
  double worst = std::log(kAlike);
  std::string out;
  for (int i = 0; i < std::min(best.drift_size(), rung.drift_size()); ++i) {
    const double ratio = rung.drift(i).predicted() / best.drift(i).predicted();
    if (!(std::abs(std::log(ratio)) > worst)) continue;
    worst = std::abs(std::log(ratio));
    out = fmt::format(
        "For the error of the integrated {} after {:g} s, the model predicts {} times what the "
        "best model predicts.",
        integral_name(rung.drift(i).unit()), rung.drift(i).seconds(), rough(ratio));
  }
  return out;
}

// What a rung lacks against the best one: how large that is, how sure that is, and what it costs.
std::string consequence_of(const v1::Rung& rung, const v1::Rung& best, double short_of_best) {
  constexpr double kNoConsequence = 0.05;
  const std::string sure =
      significance_words(std::exp(log_chi_square_tail(2.0 * std::max(0.0, short_of_best), 1.0)));
  const v1::IntegratedError* worst = nullptr;
  const auto cost = [](const v1::IntegratedError& one) {
    return std::abs(one.measured() / one.best() - 1.0);
  };
  for (const v1::IntegratedError& one : rung.drift()) {
    if (one.has_best() && one.best() > 0.0 && (worst == nullptr || cost(one) > cost(*worst)))
      worst = &one;
  }
  const std::string out =
      fmt::format("{}{:.0f} nats short of the best model, {}", size_of(rung), short_of_best, sure);
  const std::string prediction = prediction_of(rung, best);
  const std::string and_so = prediction.empty() ? "" : " " + prediction;
  if (worst == nullptr) return out + "." + and_so;
  const std::string name = integral_name(worst->unit());
  if (cost(*worst) >= kNoConsequence)
    return fmt::format(
        "{}. After {:g} s the integrated {} is off by {:.2f} times that of the best model.{}", out,
        worst->seconds(), name, worst->measured() / worst->best(), and_so);
  const double percent = 100.0 * cost(*worst) + 0.05;
  const double seconds = rung.drift().rbegin()->seconds();
  if (prediction.empty())
    return fmt::format(
        "{}, of no consequence over {:g} s: the integrated {} changes by less than {:.1f} %.", out,
        seconds, name, percent);
  return fmt::format("{}. Over {:g} s the integrated {} changes by less than {:.1f} %.{}", out,
                     seconds, name, percent, and_so);
}

std::string best_words(double promised, bool forecast) {
  const std::string best = forecast ? "The best model so far" : "The best of these models";
  if (!(promised > 0.0)) return best + ".";
  return fmt::format("{}; what it does not explain is worth {:.0f} nats on held-out data.", best,
                     promised);
}

void add_best_drift(const v1::Rung& best, v1::Rung& to) {
  for (int i = 0; i < std::min(best.drift_size(), to.drift_size()); ++i)
    to.mutable_drift(i)->set_best(best.drift(i).measured());
}

// How far a rung lies below the best; `promised`: nats that the best may still gain.
void tell(const Placed& at, const Placed& best, double promised, bool forecast) {
  v1::Rung& to = *at.rung;
  const double scores = to.heldout_scores();
  const auto error = [&](double nats) { return 1.0 + 2.0 * (nats + promised) / scores; };
  const double short_of_best = held_out_nats(*best.rung) - held_out_nats(to);
  const bool as_good = !(short_of_best > 0.0);  // itself, or the same model tried again
  to.set_unexplained(error(short_of_best));
  to.set_forecast(forecast);
  to.clear_unexplained_lower();
  to.clear_unexplained_upper();
  to.clear_single_replicate_nats();
  const std::vector<Gain> below = gained(*best.rung, to);
  if (at.parent != nullptr) {
    const std::vector<Gain> step = gained(to, *at.parent);
    if (in_one_replicate(step)) to.set_single_replicate_nats(sum(step));
  }
  if (!as_good && below.size() > 1 && !in_one_replicate(below)) {
    const double reach = reach_of_sum(below);
    to.set_unexplained_lower(std::max(1.0, error(short_of_best - reach)));
    to.set_unexplained_upper(error(short_of_best + reach));
  }
  add_best_drift(*best.rung, to);
  to.set_consequence(as_good ? best_words(promised, forecast)
                             : consequence_of(to, *best.rung, short_of_best));
}

// Fills all rungs. `settled`: a diagnosis of this rung found nothing more.
void tell_all(std::vector<Placed> rungs, const v1::Rung* settled) {
  std::erase_if(rungs, [](const Placed& one) { return one.rung->heldout_nats_size() == 0; });
  const Placed* best = nullptr;
  for (const Placed& one : rungs) {
    if (!one.counts) continue;
    if (best == nullptr || held_out_nats(*one.rung) > held_out_nats(*best->rung)) best = &one;
  }
  if (best == nullptr) return;
  double highest = best->rung->promised_nats();
  for (const Placed& one : rungs) {
    const double reached = held_out_nats(*one.rung) - held_out_nats(*best->rung) + one.promised;
    if (one.counts) highest = std::max(highest, reached);
  }
  for (const Placed& one : rungs) tell(one, *best, highest, best->rung != settled);
}

// Held-out nats that the significant candidates of a report promise its first rung.
double promised_by_candidates(const v1::DiagnosisReport& report) {
  double out = 0.0;
  for (const v1::EffectCandidate& one : report.candidates()) {
    if (one.familywise_p() < kSignificant && one.has_heldout_gain_nats())
      out = std::max(out, one.heldout_gain_nats());
  }
  return out;
}

// What the candidates leave of a rung's unexplained part.
void tell_candidates(const v1::Rung& before, v1::DiagnosisReport& to) {
  if (!before.has_unexplained()) return;
  for (v1::EffectCandidate& one : *to.mutable_candidates()) {
    if (!one.has_heldout_gain_nats()) continue;
    one.set_unexplained_before(before.unexplained());
    one.set_unexplained_after(before.unexplained() -
                              2.0 * one.heldout_gain_nats() / before.heldout_scores());
  }
}

}  // namespace

void tell_unexplained(v1::DiagnosisReport& report, std::optional<int> settled) {
  std::vector<Placed> rungs;
  for (int i = 0; i < report.ladder_size(); ++i) {
    v1::Rung& rung = *report.mutable_ladder(i);
    rungs.push_back({&rung, i > 0 ? &report.ladder(i - 1) : nullptr});
  }
  if (rungs.empty()) return;
  if (!settled) rungs.front().promised = promised_by_candidates(report);
  tell_all(rungs, settled ? &report.ladder(*settled) : nullptr);
  tell_candidates(report.ladder(0), report);
}

void tell_unexplained(v1::Study& study) {
  const auto attempt = [&](std::uint32_t place) {
    return study.mutable_attempts(static_cast<int>(place))->mutable_rung();
  };
  std::vector<Placed> rungs;
  for (const v1::StudyAttempt& one : study.attempts()) {
    v1::Rung* const rung = attempt(static_cast<std::uint32_t>(rungs.size()));
    rungs.push_back({rung, one.has_parent() ? attempt(one.parent()) : nullptr});
  }
  v1::Rung* const current = attempt(study.current());
  if (!study.has_diagnosis()) {
    tell_all(rungs, nullptr);
    return;
  }
  v1::DiagnosisReport& diagnosis = *study.mutable_diagnosis();
  for (v1::EffectCandidate& one : *diagnosis.mutable_candidates()) {
    if (!one.has_next()) continue;
    v1::Rung& next = *one.mutable_next();
    rungs.push_back({&next, current, one.familywise_p() < kSignificant});
  }
  // Copies of an attempt and of a preview.
  for (v1::Rung& one : *diagnosis.mutable_ladder()) rungs.push_back({&one, nullptr, false});
  const bool settled = diagnosis.ladder_size() == 1;
  tell_all(rungs, settled ? current : nullptr);
  tell_candidates(*current, diagnosis);
}

}  // namespace imunoise::study
