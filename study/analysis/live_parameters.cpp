#include "study/analysis/live_parameters.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <vector>

#include "core/inference/fit.h"
#include "study/analysis/fit_series.h"
#include "study/analysis/prepare.h"
#include "study/words/number.h"

namespace imunoise::study {
namespace {

WaveletVariance live_variance_of(const v1::LiveChannel& channel, const v1::LiveStream& stream) {
  WaveletVariance out;
  out.rate = Hertz{stream.nominal_hz()};
  out.samples = stream.samples();
  if (const auto unit = parse_unit(channel.units())) out.quantity = unit->quantity;
  std::vector<std::int64_t> half_widths;
  for (const v1::LiveScale& one : channel.scales())
    half_widths.push_back(std::llround(0.5 * one.tau_s() * out.rate.value));
  out.scales = Scales(std::move(half_widths));
  const auto count = static_cast<Eigen::Index>(out.scales.size());
  out.variance.resize(count);
  out.edof.resize(count);
  for (Eigen::Index j = 0; j < count; ++j) {
    const v1::LiveScale& one = channel.scales(static_cast<int>(j));
    out.variance(j) = one.deviation() * one.deviation();
    out.edof(j) = one.degrees_of_freedom();
  }
  fill_interval(out);
  return out;
}

// That of the parameter which is known worst.
v1::Observability least_known(const v1::Term& term) {
  v1::Observability out = v1::observed;
  for (const v1::Parameter& one : term.parameters()) out = std::max(out, one.observability());
  return out;
}

// How many times longer the whole replicate has to be; 0: nobody knows.
double times_longer(const v1::Term& term, const v1::LiveParameter& parameter, double precision) {
  if (parameter.observability() == v1::observed) {
    const double ratio = parameter.precision() / precision;
    return std::max(1.0, ratio * ratio);
  }
  if (parameter.observability() != v1::upper_bound_only) return 0.0;
  double out = 0.0;
  for (const v1::Parameter& one : term.parameters()) out = std::max(out, one.record_longer());
  return out;
}

std::string live_sentence(const v1::LiveParameter& parameter, double precision) {
  if (parameter.observability() == v1::indistinguishable)
    return "not told apart from another term yet";
  const std::string left =
      parameter.enough_in_s() > 0.0 ? report::duration(std::ceil(parameter.enough_in_s())) : "";
  if (parameter.observability() == v1::upper_bound_only) {
    return left.empty() ? "not seen yet; how much longer cannot be said"
                        : "not seen yet; if it is what it seems, " + left + " more would show it";
  }
  if (left.empty())
    return fmt::format("long enough: known to ±{}", report::percent(parameter.precision()));
  return fmt::format("{} more for ±{}; now ±{}", left, report::percent(precision),
                     report::percent(parameter.precision()));
}

void add_live_term(const v1::Term& term, double elapsed_s, double precision,
                   v1::LiveParameters& to) {
  for (const v1::Coefficient& one : term.coefficients()) {
    v1::LiveParameter& out = *to.add_parameters();
    out.set_term(term.name());
    *out.mutable_coefficient() = one;
    out.set_observability(least_known(term));
    if (out.observability() == v1::observed && one.value() > 0.0)
      out.set_precision(0.5 * (one.upper() - one.lower()) / one.value());
    const double times = times_longer(term, out, precision);
    if (times > 0.0) out.set_enough_in_s(elapsed_s * (times - 1.0));
    out.set_sentence(live_sentence(out, precision));
  }
}

}  // namespace

Result<v1::LiveParameters> live_parameters(const v1::LiveChannel& channel,
                                           const v1::LiveStream& stream, const std::string& model,
                                           double precision) {
  const Hertz rate{stream.nominal_hz()};
  auto parsed = parse_model(model.empty() ? std::string(kLiveModel) : model, rate);
  if (!parsed) return tl::unexpected(parsed.error());
  v1::LiveParameters out;
  out.set_model(print(*parsed));
  out.set_elapsed_s(static_cast<double>(stream.samples()) / rate.value);
  const std::size_t free = free_parameters(*parsed) + 2;
  if (static_cast<std::size_t>(channel.scales_size()) < free) {
    out.set_trouble(fmt::format("too few averaging times yet: {} of {}; record longer",
                                channel.scales_size(), free));
    return out;
  }
  const std::vector<WaveletVariance> all = {live_variance_of(channel, stream)};
  const Fit fit = infer(mugmwm(*parsed, all, Weighting::kFull), all);
  const Series series{.channel = channel.channel(), .names = {""}, .replicates = {}};
  const v1::FitReport report = fit_report(fit, series, all);
  for (const v1::Term& term : report.terms()) add_live_term(term, out.elapsed_s(), precision, out);
  return out;
}

}  // namespace imunoise::study
