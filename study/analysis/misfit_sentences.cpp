#include "study/analysis/misfit_sentences.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <functional>

namespace imunoise::study {
namespace {

constexpr double kWorthSaying = 3.0;  // standard deviations
constexpr double kOfMany = 4.0;       // of so many places some deviate by three

std::string percent_more(double ratio) {
  return ratio >= 1.0 ? fmt::format("{:.0f} % more", 100.0 * (ratio - 1.0))
                      : fmt::format("{:.0f} % less", 100.0 * (1.0 - ratio));
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
    const std::string where =
        from == until ? fmt::format("an averaging time of {:.3g} s", from)
                      : fmt::format("averaging times of {:.3g} to {:.3g} s", from, until);
    v1::Misfit& misfit = add(
        to, "scale", sigma(place.worst),
        fmt::format("At {} the recording has {} variance than the model "
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
            fmt::format("At {:.3g} to {:.3g} Hz (periods of {:.3g} to {:.3g} s) the recording has "
                        "{} power than the model ({:.1f} sigma){}.",
                        from, until, 1.0 / until, 1.0 / from, percent_more(worst.ratio),
                        std::abs(worst.sigma),
                        in_how_many(worst.replicates, to.compared_before().replicates_size())));
    misfit.set_from(from);
    misfit.set_to(until);
  }
}

void add_times(v1::DiagnosisReport& to) {
  for (const v1::TimeStretch& one : to.compared_before().times()) {
    if (std::abs(one.sigma()) < kOfMany) continue;
    v1::Misfit& misfit = add(to, "time", one.sigma(),
                             fmt::format("{}: from {:.0f} to {:.0f} s the noise has {} variance "
                                         "than in the rest ({:.1f} sigma).",
                                         one.replicate(), one.from(), one.to(),
                                         percent_more(one.ratio()), std::abs(one.sigma())));
    misfit.set_from(one.from());
    misfit.set_to(one.to());
  }
}

// A replicate that deviates more than all of them together do is a matter of its own.
void add_replicates(v1::DiagnosisReport& to) {
  const v1::NoiseBudget& budget = to.before();
  for (const v1::ReplicateResidual& one : to.compared_before().replicates()) {
    const int count = std::min(one.residual_size(), budget.scales_size());
    int worst = -1;
    for (int i = 0; i < count; ++i) {
      const double own = std::abs(one.residual(i));
      if (own < kOfMany || own < std::abs(budget.residual(i))) continue;
      if (worst < 0 || own > std::abs(one.residual(worst))) worst = i;
    }
    if (worst < 0) continue;
    v1::Misfit& misfit =
        add(to, "replicate", one.residual(worst),
            fmt::format("{}: at an averaging time of {:.3g} s it has {} variance than the model "
                        "({:.1f} sigma).",
                        one.name(), one.scales_s(worst),
                        percent_more(one.measured(worst) / budget.model(worst)),
                        std::abs(one.residual(worst))));
    misfit.set_from(one.scales_s(worst));
    misfit.set_to(one.scales_s(worst));
  }
}

void add_sensors(v1::DiagnosisReport& to) {
  constexpr double kSurely = 1e-3;
  for (const v1::SharedMotion& one : to.compared_before().pairs()) {
    if (one.first() != to.channel() || !(one.p() < kSurely)) continue;
    v1::Misfit& misfit =
        add(to, "sensors", one.sigma(),
            fmt::format("At {:.3g} to {:.3g} Hz it moves with {} (correlation {:.2f}, {:.1f} "
                        "sigma), which the model does not explain.",
                        one.from_hz(), one.to_hz(), one.second(), one.correlation(),
                        std::abs(one.sigma())));
    misfit.set_from(one.from_hz());
    misfit.set_to(one.to_hz());
  }
}

void add_kurtosis(const MisfitReport& misfit, v1::DiagnosisReport& to) {
  constexpr double kSaid = 1e-3;
  if (!(misfit.kurtosis.p_value < kSaid)) return;
  const double sigma = std::sqrt(misfit.kurtosis.statistic);
  add(to, "kurtosis", sigma,
      fmt::format("The noise is not normal: its excess kurtosis is {:.3g} ({:.1f} sigma).",
                  misfit.excess_kurtosis, sigma));
}

}  // namespace

void add_misfits(const MisfitReport& misfit, v1::DiagnosisReport& to) {
  add_scales(to);
  add_bands(misfit.bands, to);
  add_times(to);
  add_replicates(to);
  add_sensors(to);
  add_kurtosis(misfit, to);
}

}  // namespace imunoise::study
