#include "study/analysis/sentences/error_sentences.h"

#include <fmt/format.h>

#include <cmath>

#include "study/words/number.h"

namespace imunoise::study {
namespace {

// "1.2 %", "230 %" of a relative deviation.
std::string percent(double deviation) {
  constexpr double kNothing = 0.001;
  const double size = 100.0 * std::abs(deviation);
  if (size < kNothing) return fmt::format("less than {} %", kNothing);
  return size < 10.0 ? fmt::format("{:.2g} %", size) : fmt::format("{:.0f} %", size);
}

std::string more(double deviation) {
  return fmt::format("{} {}", percent(deviation), deviation < 0.0 ? "less" : "more");
}

// Where a view is worst, and how far off the model is there.
std::string worst_words(const ErrorView& from, const std::vector<std::string>& replicates) {
  const ErrorView::Place& at = from.worst;
  if (from.view == "averaging_times")
    return fmt::format("Worst at an averaging time of {} s: {} Allan deviation than the model",
                       report::brief(at.from), more(at.deviation));
  if (from.view == "spectrum")
    return fmt::format("Worst at {} to {} Hz: {} power than the model", report::brief(at.from),
                       report::brief(at.to), more(at.deviation));
  if (from.view == "single_waves")
    return fmt::format("The strongest wave, at {} Hz, is {:.1f} dB over the noise",
                       report::brief(at.from, 4), from.value);
  if (from.view == "noise_over_time")
    return fmt::format("Worst in {} from {} s: {} power than in the rest", replicates[at.replicate],
                       report::stretch(at.from, at.to), more(at.deviation));
  if (from.view == "distribution")
    return fmt::format("The tails are {} than normal ones: excess kurtosis {}",
                       at.deviation < 0.0 ? "lighter" : "heavier", report::brief(at.deviation, 2));
  if (from.view == "witnesses")
    return fmt::format("{} explains most: {:.2g} % of the power of the innovations", at.witness,
                       from.value);
  return fmt::format("{} deviates most: {} power than the mean", replicates[at.replicate],
                     more(at.deviation));
}

// How often one of so many views would deviate as much under a true model.
double of_many(double p, std::size_t views) {
  return -std::expm1(static_cast<double>(views) * std::log1p(-p));
}

v1::ErrorView message_of(const ErrorView& from, std::size_t views, const Subject& subject,
                         const std::vector<std::string>& replicates) {
  ErrorView placed = from;
  if (from.view == "averaging_times") {  // an Allan deviation's is half of its wavelet's
    placed.worst.from *= 0.5;
    placed.worst.to *= 0.5;
  }
  if (from.view == "noise_over_time") {
    placed.worst.from += subject.begins(from.worst.replicate);
    placed.worst.to += subject.begins(from.worst.replicate);
  }
  v1::ErrorView out;
  out.set_view(std::string(from.view));
  out.set_unit(std::string(from.unit));
  out.set_value(from.value);
  out.set_floor(from.floor);
  out.set_chance_limit(from.chance_limit);
  out.set_p(from.p_value);
  if (std::isfinite(placed.worst.from)) out.set_from(placed.worst.from);
  if (std::isfinite(placed.worst.to)) out.set_to(placed.worst.to);
  out.set_sentence(fmt::format("{}; {}.", worst_words(placed, replicates),
                               significance_words(of_many(from.p_value, views))));
  return out;
}

}  // namespace

std::string significance_words(double p) {
  constexpr double kFarBeyond = 1e-6;
  constexpr double kBeyond = 0.01;
  constexpr double kLimit = 0.05;
  if (p < kFarBeyond) return "far beyond chance";
  if (p < kBeyond) return "beyond chance";
  return p < kLimit ? "at the limit of chance" : "no more than chance";
}

std::vector<v1::ErrorView> views_of(const FittedModel& trial, const LeftOver& left,
                                    const MisfitReport& misfit,
                                    const std::vector<std::string>& replicates) {
  std::vector<v1::ErrorView> out;
  const std::vector<ErrorView> views = error_views(trial, left, misfit);
  for (const ErrorView& one : views)
    out.push_back(message_of(one, views.size(), trial.regression.subject(), replicates));
  return out;
}

}  // namespace imunoise::study
