#include "study/analysis/dynamic_series.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "core/effects/parse_full_model.h"
#include "core/model/trend.h"
#include "study/analysis/prepare.h"
#include "study/analysis/vocabulary.h"
#include "study/words/number.h"

namespace imunoise::study {
namespace {

constexpr int kCurvePoints = 41;

Result<Model> read_dynamic_model(const std::optional<std::string>& text, Hertz rate) {
  Result<Model> model = parse_noise_model(text ? std::string_view(*text) : kDefaultDynamicModel,
                                          rate, grammar_over_covariate());
  if (!model) return model;
  if (!varies(*model)) model = with_varying_powers(std::move(*model));
  if (varies(*model)) return model;
  return fail(
      fmt::format("model: {} fixes every power, so no parameter depends on the covariate; "
                  "leave one open, or mark a parameter: AR1(sigma2=1, phi~)",
                  print(*model)));
}

void fill(const TestOutcome& from, v1::TestResult& to) {
  to.set_statistic(from.statistic);
  to.set_degrees_of_freedom(from.degrees_of_freedom);
  if (from.degrees_of_freedom == 0) return;
  to.set_p_value(from.p_value);
  to.set_rejected(from.p_value <= kLevel);
}

// A value with what is known of its interval, in another unit.
template <class Estimate>
void fill(double covariate, const Estimate& from, double factor, v1::CovariatePoint& to) {
  to.set_covariate(covariate);
  to.set_value(from.value * factor);
  if (std::isfinite(from.lower)) to.set_lower(from.lower * factor);
  if (std::isfinite(from.upper)) to.set_upper(from.upper * factor);
}

const DerivedEstimate* find(const std::vector<DerivedEstimate>& all, Coefficient coefficient) {
  const auto found = std::find_if(all.begin(), all.end(), [&](const DerivedEstimate& one) {
    return one.coefficient == coefficient;
  });
  return found == all.end() ? nullptr : &*found;
}

// Everything that a term is known by, over the covariate.
void add_quantities(const DynamicFit& fit, const std::vector<CovariateBin>& bins, std::size_t term,
                    Quantity measures, v1::DynamicReport& out) {
  const double low = bins.front().covariate;
  const double high = bins.back().covariate;
  std::vector<TermEstimate> curve;
  std::vector<TermEstimate> at_bins;
  const auto place = [&](int i) { return low + (high - low) * i / (kCurvePoints - 1); };
  for (int i = 0; i < kCurvePoints; ++i) curve.push_back(estimates_at(fit, place(i))[term]);
  for (const CovariateBin& bin : bins) at_bins.push_back(estimates_at(fit, bin.covariate)[term]);
  for (const DerivedEstimate& known : at_bins.front().derived) {
    const CoefficientUnits units = coefficient_units(known.coefficient, measures);
    const bool customary = !units.datasheet.empty();
    const double factor = customary ? units.to_datasheet : 1.0;
    v1::DynamicQuantity& to = *out.add_quantities();
    to.set_term(label_of(fit.model, term));
    to.set_symbol(std::string(units.symbol));
    to.set_title(std::string(units.title));
    to.set_unit(customary ? units.datasheet : units.si);
    for (int i = 0; i < kCurvePoints; ++i) {
      const auto* one = find(curve[static_cast<std::size_t>(i)].derived, known.coefficient);
      if (one != nullptr) fill(place(i), *one, factor, *to.add_curve());
    }
    for (std::size_t b = 0; b < bins.size(); ++b) {
      const double at = bins[b].covariate;
      if (const auto* one = find(at_bins[b].derived, known.coefficient)) {
        fill(at, *one, factor, *to.add_bins());
      }
      if (!fit.separate[b]) continue;
      if (const auto* one = find(fit.separate[b]->derived[term], known.coefficient)) {
        fill(at, *one, factor, *to.add_separate());
      }
    }
    // Of a term that follows the covariate, some coefficients may not.
    const double first = to.bins().begin()->value();
    const bool same =
        to.bins_size() == std::ssize(bins) && first > 0.0 && first == to.bins().rbegin()->value();
    to.set_varies(varies(fit.model.terms[term]) && !same);
  }
}

void add_trends(const DynamicFit& fit, const std::vector<CovariateBin>& bins, Quantity measures,
                v1::DynamicReport& out) {
  const double low = bins.front().covariate;
  const double high = bins.back().covariate;
  const std::vector<TermEstimate> first = estimates_at(fit, low);
  const std::vector<TermEstimate> last = estimates_at(fit, high);
  for (const TrendEstimate& from : fit.trends) {
    const ParameterInfo about = parameters(fit.model.terms[from.term].process)[from.parameter];
    v1::ParameterTrend& to = *out.add_trends();
    to.set_term(label_of(fit.model, from.term));
    to.set_parameter(about.name);
    to.set_unit(unit_of(about.dimension, measures));
    to.set_link(std::string(word_of(from.link)));
    to.set_slope(from.slope);
    if (std::isfinite(from.standard_error)) {
      to.set_slope_lower(from.lower);
      to.set_slope_upper(from.upper);
    }
    fill(from.test, *to.mutable_test());
    fill(low, first[from.term].parameters[from.parameter], 1.0, *to.mutable_first());
    fill(high, last[from.term].parameters[from.parameter], 1.0, *to.mutable_last());
  }
}

void add_bins(const DynamicFit& fit, const Bins& bins, v1::DynamicReport& out) {
  for (std::size_t b = 0; b < bins.bins.size(); ++b) {
    const Bin& from = bins.bins[b];
    v1::DynamicBin& to = *out.add_bins();
    to.set_covariate(from.mean);
    to.set_lower(from.lower);
    to.set_upper(from.upper);
    to.set_samples(static_cast<std::uint32_t>(from.samples));
    to.set_runs(static_cast<std::uint32_t>(from.runs.size()));
    to.set_model(print_with_values(model_at(fit.model, fit.axis(from.mean))));
    fill(fit.misfit_in[b], *to.mutable_misfit());
  }
}

std::string with_unit(double value, const std::string& unit) {
  return report::brief(value) + (unit.empty() || unit == "1" ? "" : " " + unit);
}

bool clear_of_zero(const v1::CovariatePoint& point) { return point.lower() > 0.0; }

// "0.146 °/√h at 30 deg/s", or what it is less than.
std::string place_words(const v1::CovariatePoint& point, const std::string& unit,
                        const v1::DynamicReport& report) {
  const bool clear = clear_of_zero(point);
  return fmt::format("{}{} at {}", clear ? "" : "less than ",
                     with_unit(clear ? point.value() : point.upper(), unit),
                     with_unit(point.covariate(), report.covariate_unit()));
}

// "N of WN grows from 0.146 °/√h at 30 deg/s to 0.439 °/√h at 390 deg/s."
std::string what_moves(const v1::DynamicReport& report) {
  std::string out;
  for (const v1::DynamicQuantity& one : report.quantities()) {
    const bool follows = std::any_of(
        report.trends().begin(), report.trends().end(),
        [&](const auto& trend) { return trend.term() == one.term() && trend.test().rejected(); });
    if (!follows || !one.varies() || one.bins_size() < 2) continue;
    const v1::CovariatePoint& first = *one.bins().begin();
    const v1::CovariatePoint& last = *one.bins().rbegin();
    if (!clear_of_zero(first) && !clear_of_zero(last)) continue;
    out +=
        fmt::format("{} of {} {} from {} to {}. ", one.symbol(), one.term(),
                    last.value() > first.value() ? "grows" : "falls",
                    place_words(first, one.unit(), report), place_words(last, one.unit(), report));
  }
  return out.empty() ? fmt::format("No parameter depends significantly on {}. ", report.covariate())
                     : out;
}

std::string summary_of(const v1::DynamicReport& report) {
  std::string out = what_moves(report);
  const std::string misfit = chance_words(report.misfit().p_value());
  const std::string links = chance_words(report.links().p_value());
  if (report.misfit().degrees_of_freedom() == 0) {
    out += "There are too few scales to test the model";
  } else if (report.misfit().rejected()) {
    out += fmt::format(
        "The model does not fit even single bins ({}): a process "
        "is missing",
        misfit);
  } else {
    out += fmt::format("The model fits each bin ({})", misfit);
  }
  if (report.links().degrees_of_freedom() == 0) {
    return out + "; there are too few bins to test the curves.";
  }
  return out +
         (report.links().rejected()
              ? fmt::format("; the curves miss the bins ({}): look at the points beside them, "
                            "and try another link, or let more parameters depend on it.",
                            links)
              : fmt::format("; the curves follow the bins ({}).", links));
}

void add_notes(const DynamicFit& fit, const CovariateData& covariate, const DynamicOptions& options,
               std::size_t samples, v1::DynamicReport& out) {
  const std::size_t left_out = covariate.bins.left_out;
  if (left_out > 0) {
    out.add_notes(fmt::format(
        "{} of {} samples were discarded: between the bins, settling, or in runs of fewer than {}.",
        left_out, samples, kLeastRun));
  }
  if (!covariate.bins.plateaus) {
    out.add_notes(fmt::format(
        "{} moves through the bins instead of staying: its effect on the output of the sensor "
        "within a bin counts as noise.",
        covariate.name));
  }
  const auto alone = std::count_if(fit.separate.begin(), fit.separate.end(),
                                   [](const auto& one) { return one.has_value(); });
  if (alone < std::ssize(fit.separate)) {
    out.add_notes(fmt::format(
        "{} of {} bins are too short to be fitted by themselves; they count in the curves.",
        std::ssize(fit.separate) - alone, fit.separate.size()));
  }
  if (!options.model) out.add_notes(default_model_note("was fitted", kDefaultDynamicModel));
}

Result<v1::DynamicReport> dynamic_series(const Series& series, const CovariateData& covariate,
                                         const DynamicOptions& options, const Progress& progress) {
  const Hertz rate = series.replicates.front().rate();
  const Result<Model> model = read_dynamic_model(options.model, rate);
  if (!model) return tl::unexpected(model.error());
  const auto bins = measure_bins(series, covariate, options.measure, progress.part(0.0, 0.3));
  if (!bins) return tl::unexpected(bins.error());
  std::vector<WaveletVariance> all;
  for (const CovariateBin& bin : *bins) all.insert(all.end(), bin.runs.begin(), bin.runs.end());
  if (auto sound = can_be_fitted(*model, all); !sound) return tl::unexpected(sound.error());
  const DynamicFit fit = fit_dynamic(*model, *bins, options.confidence, progress.part(0.3, 1.0));
  if (progress.stopped()) return fail("stopped");

  const Quantity quantity = series.replicates.front().quantity();
  v1::DynamicReport out;
  out.set_channel(series.channel);
  out.set_unit(std::string(si_symbol(quantity)));
  out.set_rate_hz(rate.value);
  out.set_covariate(covariate.name);
  out.set_covariate_unit(covariate.unit);
  out.set_recordings(static_cast<std::uint32_t>(series.replicates.size()));
  out.set_plateaus(covariate.bins.plateaus);
  out.set_left_out(static_cast<std::uint32_t>(covariate.bins.left_out));
  out.set_model(print(*model));
  out.set_termination(std::string(describe(fit.termination)));
  out.set_objective(fit.objective);
  out.set_estimator("dynamic GMWM");
  out.set_confidence(fit.confidence);
  add_bins(fit, covariate.bins, out);
  add_trends(fit, *bins, quantity, out);
  for (std::size_t t = 0; t < fit.model.terms.size(); ++t) {
    add_quantities(fit, *bins, t, quantity, out);
  }
  fill(fit.misfit, *out.mutable_misfit());
  fill(fit.links, *out.mutable_links());
  out.set_summary(summary_of(out));
  std::size_t samples = 0;
  for (const Signal& one : series.replicates) samples += one.size();
  add_notes(fit, covariate, options, samples, out);
  return out;
}

bool wanted(const std::string& channel, const DynamicOptions& options) {
  if (options.channels.empty()) return channel != options.covariate.channel;
  return std::find(options.channels.begin(), options.channels.end(), channel) !=
         options.channels.end();
}

}  // namespace

Result<v1::DynamicReports> dynamic_channels(const std::vector<recording::Replicate>& recordings,
                                            const DynamicOptions& options,
                                            const Progress& progress) {
  // A model that cannot be read is told before minutes are spent on measuring.
  if (auto good = read_dynamic_model(options.model, recordings.front().rate); !good) {
    return tl::unexpected(good.error());
  }
  const Result<CovariateData> covariate = covariate_data(recordings, options.covariate);
  if (!covariate) return tl::unexpected(covariate.error());
  v1::DynamicReports out;
  const std::vector<recording::Channel>& channels = recordings.front().channels;
  for (std::size_t i = 0; i < channels.size(); ++i) {
    if (!wanted(channels[i].name, options)) continue;
    const auto share = [&](std::size_t c) {
      return static_cast<double>(c) / static_cast<double>(channels.size());
    };
    auto report = dynamic_series(series_of(recordings, i), *covariate, options,
                                 progress.part(share(i), share(i + 1)));
    if (!report) return tl::unexpected(report.error());
    *out.add_channels() = std::move(*report);
  }
  if (out.channels_size() == 0) {
    return fail(
        fmt::format("{} is the only channel: name it with --channel too if its own noise "
                    "is what is to be analysed",
                    options.covariate.channel));
  }
  return out;
}

}  // namespace imunoise::study
