#include "study/report/view/verdict.h"

#include <fmt/format.h>

#include <cmath>

#include "core/support/counted.h"
#include "study/words/number.h"

namespace imunoise::report {
namespace {

// "in 37 % of", "in 1 of 250", "in fewer than 1 of 10 000".
std::string how_often(double p) {
  if (p >= 0.01) return "in " + percent(p) + " of";
  if (p < 1e-4) return "in fewer than 1 of 10 000";
  return "in 1 of " + count(static_cast<std::uint64_t>(std::llround(1.0 / p)), Digits::kPlain);
}

}  // namespace

Verdict verdict(const v1::FitReport& report) {
  return report.degrees_of_freedom() <= 0 ? Verdict::kUntested : verdict_at(report.p_value());
}

std::string verdict_sentence(const v1::FitReport& report) {
  const Verdict v = verdict(report);
  if (v == Verdict::kUntested) {
    return "There are as many parameters as tested scales: none is left to test the model "
           "with.";
  }
  return fmt::format(
      "If the model is true, random errors cause differences this large {} recordings.",
      how_often(report.p_value()));
}

std::string facts(const v1::FitReport& report) {
  std::string out;
  const auto fact = [&out](const std::string& text) {
    if (!text.empty()) out += (out.empty() ? "" : " · ") + text;
  };
  fact(report.model());
  fact(report.quantity());
  if (report.rate_hz() > 0.0) fact(fmt::format("{:g} Hz", report.rate_hz()));
  if (const int n = report.replicates_size(); n > 0) fact(counted(n, "replicate"));
  return out + estimator_fact(report.estimator());
}

std::string estimator_fact(const std::string& estimator) {
  return estimator.empty() ? "" : " · by " + estimator;
}

std::string channel_name(const std::string& channel) {
  return channel.empty() ? "unnamed channel" : channel;
}

std::vector<Misfit> misfits(const BudgetView& view) {
  std::vector<Misfit> out;
  for (std::size_t k = 0; k < view.scales.size(); ++k) {
    const ScaleView& scale = view.scales[k];
    if (!scale.outside()) continue;
    const bool joins =
        !out.empty() && out.back().last + 1 == k &&
        std::signbit(view.scales[out.back().last].residual) == std::signbit(scale.residual);
    if (!joins) {
      out.push_back({k, k, k});
      continue;
    }
    out.back().last = k;
    const double worst = view.scales[out.back().worst].residual;
    if (std::abs(scale.residual) > std::abs(worst)) out.back().worst = k;
  }
  return out;
}

std::string misfit_words(const BudgetView& view, const Misfit& misfit) {
  const ScaleView& worst = view.scales[misfit.worst];
  std::string out = misfit.first == misfit.last
                        ? "at " + duration(view.scales[misfit.first].seconds)
                        : "from " + duration(view.scales[misfit.first].seconds) + " to " +
                              duration(view.scales[misfit.last].seconds);
  const double ratio = worst.measured / worst.model;
  if (std::isfinite(ratio)) {
    out += ": variance " + percent(std::abs(ratio - 1.0)) +
           (worst.residual > 0.0 ? " above the model" : " below the model");
  }
  return out + " (" + signed_sigma(worst.residual, Digits::kTypeset) + " σ)";
}

bool only_bounded(const v1::Parameter& parameter) {
  return parameter.observability() == v1::upper_bound_only;
}

std::string observability_words(const v1::Term& term, const v1::Parameter& parameter) {
  const v1::Parameter& power = term.parameters(0);
  switch (parameter.observability()) {
    case v1::observed:
      if (only_bounded(power) && &parameter != &power) return "seen only if this noise is there";
      return parameter.value() > 0.0 && parameter.lower() == 0.0
                 ? "barely seen: its interval reaches zero"
                 : "seen in the data";
    case v1::given:
      return "given by the user";
    case v1::indistinguishable:
      return "cannot be told apart from another term";
    case v1::upper_bound_only: {
      std::string out = "not seen: may be zero";
      if (std::isfinite(parameter.record_longer()) && parameter.record_longer() > 0.0) {
        out += fmt::format("; record {}× longer to see it",
                           number(parameter.record_longer(), 2, Digits::kPlain));
      }
      return out;
    }
    default:
      return {};
  }
}

}  // namespace imunoise::report
