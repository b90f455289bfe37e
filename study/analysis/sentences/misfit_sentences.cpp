#include "study/analysis/sentences/misfit_sentences.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <functional>
#include <set>

#include "core/support/counted.h"
#include "study/words/number.h"

namespace imunoise::study {
namespace {

constexpr double kWorthSaying = 3.0;  // standard deviations
constexpr double kOfMany = 4.0;       // of so many places some deviate by three
constexpr int kMostSentences = 12;

std::string percent_more(double ratio) {
  return fmt::format("{} % {}",
                     report::number(100.0 * std::abs(ratio - 1.0), 2, report::Digits::kPlain),
                     ratio >= 1.0 ? "more" : "less");
}

std::string in_how_many(int found, int all) {
  if (all == 1) return "";
  return found == all ? fmt::format(", in all {} replicates", all)
                      : fmt::format(", in {} of {} replicates", found, all);
}

v1::Misfit& add(v1::DiagnosisReport& to, const char* kind, double sigma,
                const std::string& sentence) {
  v1::Misfit& out = *to.add_misfits();
  out.set_kind(kind);
  out.set_sigma(sigma);
  out.set_sentence(sentence);
  return out;
}

// Neighbours that deviate to the same side are one place.
struct Place {
  int begin = 0;
  int end = 0;
  int worst = 0;
};
std::vector<Place> places(int count, const std::function<double(int)>& sigma) {
  std::vector<Place> out;
  for (int i = 0; i < count;) {
    if (!(std::abs(sigma(i)) >= kWorthSaying)) {
      ++i;
      continue;
    }
    Place one{i, i, i};
    while (one.end < count && std::abs(sigma(one.end)) >= kWorthSaying &&
           (sigma(one.end) > 0.0) == (sigma(i) > 0.0)) {
      if (std::abs(sigma(one.end)) > std::abs(sigma(one.worst))) one.worst = one.end;
      ++one.end;
    }
    out.push_back(one);
    i = one.end;
  }
  return out;
}

// Replicates whose variance at an averaging time lies on the same side as a score.
int agreeing(const v1::Comparison& compared, double seconds, double sigma) {
  int out = 0;
  for (const v1::ReplicateResidual& one : compared.replicates()) {
    for (int i = 0; i < one.scales_s_size(); ++i) {
      if (one.scales_s(i) == seconds && (one.residual(i) > 0.0) == (sigma > 0.0)) ++out;
    }
  }
  return out;
}

void add_scales(v1::DiagnosisReport& to) {
  const v1::NoiseBudget& budget = to.before();
  const auto sigma = [&](int i) { return budget.tested(i) ? budget.residual(i) : 0.0; };
  for (const Place& place : places(budget.scales_size(), sigma)) {
    const double from = budget.scales_s(place.begin);
    const double until = budget.scales_s(place.end - 1);
    const std::string where = from == until
                                  ? fmt::format("an averaging time of {} s", report::brief(from))
                                  : fmt::format("averaging times of {} to {} s",
                                                report::brief(from), report::brief(until));
    v1::Misfit& misfit = add(
        to, "scale", sigma(place.worst),
        fmt::format("At {} the recording has {} wavelet variance than the model "
                    "({:.1f} sigma){}.",
                    where, percent_more(budget.measured(place.worst) / budget.model(place.worst)),
                    std::abs(sigma(place.worst)),
                    in_how_many(agreeing(to.compared_before(), budget.scales_s(place.worst),
                                         sigma(place.worst)),
                                to.compared_before().replicates_size())));
    misfit.set_from(from);
    misfit.set_to(until);
  }
}

void add_bands(const std::vector<BandMisfit>& bands, v1::DiagnosisReport& to) {
  const auto at = [&](int i) -> const BandMisfit& { return bands[static_cast<std::size_t>(i)]; };
  for (const Place& place :
       places(static_cast<int>(bands.size()), [&](int i) { return at(i).sigma; })) {
    const BandMisfit& worst = at(place.worst);
    const double from = at(place.begin).from;
    const double until = at(place.end - 1).to;
    v1::Misfit& misfit =
        add(to, "frequency", worst.sigma,
            fmt::format("At {} to {} Hz (periods of {} to {} s) the recording has "
                        "{} power than the model ({:.1f} sigma){}.",
                        report::brief(from), report::brief(until), report::brief(1.0 / until),
                        report::brief(1.0 / from), percent_more(worst.ratio), std::abs(worst.sigma),
                        in_how_many(worst.replicates, to.compared_before().replicates_size())));
    misfit.set_from(from);
    misfit.set_to(until);
  }
}

// The stretches of all replicates that are noisier, or quieter, than the rest: one sentence.
void add_stretches(v1::DiagnosisReport& to, double side) {
  const v1::TimeStretch* worst = nullptr;
  std::set<std::string> replicates;
  int stretches = 0;
  for (const v1::TimeStretch& one : to.compared_before().times()) {
    if (!(side * one.sigma() >= kOfMany)) continue;
    ++stretches;
    replicates.insert(one.replicate());
    if (worst == nullptr || side * one.sigma() > side * worst->sigma()) worst = &one;
  }
  if (worst == nullptr) return;
  std::string others;
  if (stretches > 1)
    others = fmt::format(" The same holds in {} of {}; this is the worst.",
                         counted(stretches, "stretch"), counted(replicates.size(), "replicate"));
  v1::Misfit& misfit =
      add(to, "time", worst->sigma(),
          fmt::format("{}: from {} s the noise has {} variance than in the rest "
                      "({:.1f} sigma).{}",
                      worst->replicate(), report::stretch(worst->from(), worst->to()),
                      percent_more(worst->ratio()), std::abs(worst->sigma()), others));
  misfit.set_from(worst->from());
  misfit.set_to(worst->to());
}

// Where a replicate deviates more than all of them together do.
struct OwnMisfit {
  const v1::ReplicateResidual* replicate = nullptr;
  int scale = 0;
  double sigma = 0.0;
};

OwnMisfit own_misfit(const v1::ReplicateResidual& one, const v1::NoiseBudget& budget) {
  OwnMisfit out{&one};
  for (int i = 0; i < std::min(one.residual_size(), budget.residual_size()); ++i) {
    const double own = one.residual(i);
    if (std::abs(own) < std::max(kOfMany, std::abs(budget.residual(i)))) continue;
    if (std::abs(own) > std::abs(out.sigma)) out = {&one, i, own};
  }
  return out;
}

// The replicates that are noisier, or quieter, than the model: one sentence.
void add_replicates(v1::DiagnosisReport& to, double side) {
  const v1::NoiseBudget& budget = to.before();
  std::vector<OwnMisfit> found;
  for (const v1::ReplicateResidual& one : to.compared_before().replicates()) {
    const OwnMisfit own = own_misfit(one, budget);
    if (side * own.sigma > 0.0) found.push_back(own);
  }
  if (found.empty()) return;
  std::stable_sort(found.begin(), found.end(), [](const OwnMisfit& a, const OwnMisfit& b) {
    return std::abs(a.sigma) > std::abs(b.sigma);
  });
  const OwnMisfit& worst = found.front();
  std::string others;
  for (std::size_t i = 1; i < found.size(); ++i)
    others += fmt::format("{}{}", i == 1 ? "" : ", ", found[i].replicate->name());
  if (!others.empty()) others = fmt::format(" Likewise, less surely: {}.", others);
  const double seconds = worst.replicate->scales_s(worst.scale);
  v1::Misfit& misfit = add(
      to, "replicate", worst.sigma,
      fmt::format("{}: at an averaging time of {} s it has {} wavelet variance than the "
                  "model ({:.1f} sigma).{}",
                  worst.replicate->name(), report::brief(seconds),
                  percent_more(worst.replicate->measured(worst.scale) / budget.model(worst.scale)),
                  std::abs(worst.sigma), others));
  misfit.set_from(seconds);
  misfit.set_to(seconds);
}

void add_sensors(v1::DiagnosisReport& to) {
  constexpr double kSurely = 1e-3;
  for (const v1::SharedMotion& one : to.compared_before().pairs()) {
    if (one.first() != to.channel() || !(one.p() < kSurely)) continue;
    v1::Misfit& misfit =
        add(to, "sensors", one.sigma(),
            fmt::format("At {} to {} Hz it moves with {} (correlation {:.2f}, {:.1f} "
                        "sigma), which the model does not explain.",
                        report::brief(one.from_hz()), report::brief(one.to_hz()), one.second(),
                        one.correlation(), std::abs(one.sigma())));
    misfit.set_from(one.from_hz());
    misfit.set_to(one.to_hz());
  }
}

void add_kurtosis(const MisfitReport& misfit, v1::DiagnosisReport& to) {
  constexpr double kSaid = 1e-3;
  if (!(misfit.kurtosis.p_value < kSaid)) return;
  const double sigma = std::sqrt(misfit.kurtosis.statistic);
  add(to, "kurtosis", sigma,
      fmt::format("The noise is not normal: its excess kurtosis is {} ({:.1f} sigma).",
                  report::brief(*misfit.excess_kurtosis), sigma));
}

void keep_worst(google::protobuf::RepeatedPtrField<v1::Misfit>& misfits) {
  std::stable_sort(misfits.pointer_begin(), misfits.pointer_end(),
                   [](const v1::Misfit* a, const v1::Misfit* b) {
                     return std::abs(a->sigma()) > std::abs(b->sigma());
                   });
  if (misfits.size() > kMostSentences)
    misfits.DeleteSubrange(kMostSentences, misfits.size() - kMostSentences);
}

}  // namespace

void add_misfits(const MisfitReport& misfit, v1::DiagnosisReport& to) {
  add_scales(to);
  add_bands(misfit.bands, to);
  for (const double side : {1.0, -1.0}) {
    add_stretches(to, side);
    add_replicates(to, side);
  }
  add_sensors(to);
  add_kurtosis(misfit, to);
  keep_worst(*to.mutable_misfits());
}

}  // namespace imunoise::study
