#include "study/analysis/test_series.h"

#include <fmt/format.h>

#include "study/analysis/prepare.h"
#include "study/analysis/vocabulary.h"

namespace imunoise::study {
namespace {

void fill(const BootstrappedTest& from, v1::TestResult& to) {
  to.set_statistic(from.asymptotic.statistic);
  to.set_degrees_of_freedom(from.asymptotic.degrees_of_freedom);
  if (from.asymptotic.degrees_of_freedom == 0) return;
  to.set_p_value(from.asymptotic.p_value);
  if (from.bootstrap_p_value) to.set_bootstrap_p_value(*from.bootstrap_p_value);
  to.set_rejected(from.p_value() <= kLevel);
}

// Where there is nothing to ask one of the questions about.
std::string half_summary(const v1::StationarityReport& report, const std::string& misfit,
                         const std::string& differ) {
  std::string out;
  if (report.misfit().degrees_of_freedom() == 0) {
    out = "There are too few scales to test the model";
  } else if (report.misfit().rejected()) {
    out = fmt::format("The model does not fit the replicates ({})", misfit);
  } else {
    out = fmt::format("The model fits every replicate ({})", misfit);
  }
  if (report.heterogeneity().degrees_of_freedom() == 0) {
    return out +
           "; the data show none of its free parameters, so that none can be compared between "
           "replicates.";
  }
  return out + (report.heterogeneity().rejected()
                    ? fmt::format("; its parameters differ significantly ({}).", differ)
                    : fmt::format("; one set of parameters fits them all ({}).", differ));
}

std::string summary_of(const v1::StationarityReport& report, const NearStationarity& result) {
  constexpr std::uint32_t kFewestForEach = 3;  // replicates, of a test of a single parameter
  const std::string misfit = chance_words(result.misfit.p_value());
  const std::string differ = chance_words(result.heterogeneity.p_value());
  if (report.misfit().degrees_of_freedom() == 0 ||
      report.heterogeneity().degrees_of_freedom() == 0) {
    return half_summary(report, misfit, differ);
  }
  const std::string who = moving_words(report.spread());
  const std::string moves = !who.empty() ? "Different: " + who + "."
                            : report.replicates() < kFewestForEach
                                ? "To tell which of them differs takes three replicates."
                                : "No single parameter stands out.";
  if (!report.misfit().rejected() && !report.heterogeneity().rejected()) {
    return fmt::format(
        "Near-stationary: the model fits every replicate ({}), and one set of parameters "
        "fits them all ({}).",
        misfit, differ);
  }
  if (!report.heterogeneity().rejected()) {
    return fmt::format(
        "The replicates agree with each other ({}), but the model does not fit them "
        "({}): a process is missing, the same in all. More replicates do not help; a "
        "better model does.",
        differ, misfit);
  }
  if (!report.misfit().rejected()) {
    return fmt::format(
        "The model fits every replicate ({}), but their parameters differ significantly "
        "({}). {} One set of parameters describes their average, not the next recording.",
        misfit, differ, moves);
  }
  return fmt::format(
      "Two problems: the model does not fit the replicates even with separate parameters "
      "({}), and these parameters differ significantly ({}). {} Find the missing "
      "process first: it can look like a parameter that differs.",
      misfit, differ, moves);
}

}  // namespace

void add_spread(const NearStationarity& result, Quantity quantity,
                google::protobuf::RepeatedPtrField<v1::ParameterSpread>& out) {
  const Model& model = result.pooled.model;
  for (const ParameterSpread& from : result.spread) {
    const ParameterInfo about = parameters(model.terms[from.term].process)[from.parameter];
    v1::ParameterSpread& to = *out.Add();
    to.set_term(label_of(model, from.term));
    to.set_parameter(about.name);
    to.set_unit(unit_of(about.dimension, quantity));
    to.set_replicates(static_cast<std::uint32_t>(from.replicates));
    to.set_mean(from.mean);
    to.set_spread(from.spread);
    to.set_lower(from.lower);
    to.set_upper(from.upper);
    to.set_relative(from.relative);
    to.set_relative_lower(from.relative_lower);
    to.set_relative_upper(from.relative_upper);
    to.set_p_value(from.p_value);
    to.set_moves(from.moves());
  }
}

std::string moving_words(const google::protobuf::RepeatedPtrField<v1::ParameterSpread>& spread) {
  std::string out;
  for (const v1::ParameterSpread& one : spread) {
    if (!one.moves()) continue;
    const bool decays = one.parameter() == "phi" || one.parameter() == "r";
    const bool near_one = decays && one.mean() > 0.5;
    out += fmt::format("{}{}{} of {} by {:.2g} %", out.empty() ? "" : ", ", near_one ? "1 - " : "",
                       one.parameter(), one.term(), 100.0 * one.relative());
  }
  return out;
}

Result<v1::StationarityReport> test_series(const Series& series, const TestOptions& options,
                                           const Progress& progress) {
  if (series.replicates.size() < 2) {
    return fail(fmt::format(
        "{}: a test between replicates needs at least two: name more files, or cut this one with "
        "--split-into 6 (parts of one recording show less than recordings of different days)",
        series.channel));
  }
  if (auto enough = check_bootstrap(static_cast<std::size_t>(options.bootstrap.sets)); !enough)
    return tl::unexpected(enough.error());
  const Result<Prepared> prepared =
      prepare(series, options.model ? *options.model : kDefaultModel,
              grammar_of_replicates("imunoise test"), options.measure, progress.part(0.0, 0.3));
  if (!prepared) return tl::unexpected(prepared.error());
  const NearStationarity result = near_stationarity(prepared->left.noise, prepared->measured,
                                                    options.bootstrap, progress.part(0.3, 1.0));
  if (progress.stopped()) return fail("stopped");

  v1::StationarityReport out;
  out.set_channel(series.channel);
  out.set_unit(std::string(si_symbol(prepared->measured.front().quantity)));
  out.set_rate_hz(series.replicates.front().rate().value);
  add_effects(prepared->left, result.pooled.model, out);
  out.set_estimator(moments_estimator(series.replicates.size()));
  out.set_replicates(static_cast<std::uint32_t>(series.replicates.size()));
  fill(result.misfit, *out.mutable_misfit());
  fill(result.heterogeneity, *out.mutable_heterogeneity());
  out.set_published_statistic(result.published_statistic);
  if (result.published_p_value) out.set_published_p_value(*result.published_p_value);
  out.set_bootstrap_sets(static_cast<std::uint32_t>(options.bootstrap.sets));
  out.set_seed(options.bootstrap.seed);
  add_spread(result, prepared->measured.front().quantity, *out.mutable_spread());
  out.set_summary(summary_of(out, result));
  if (series.replicates.size() < 5) {
    out.add_notes(fmt::format(
        "{} replicates hardly show how much the next one will differ: the intervals of the "
        "spread are wide. Record at least 6.",
        series.replicates.size()));
  }
  if (!options.model) out.add_notes(default_model_note("was tested"));
  progress.report(1.0);
  return out;
}

}  // namespace imunoise::study
