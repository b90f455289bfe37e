#include "study/analysis/arrays/mixed_series.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "core/array/array_whittle.h"
#include "core/effects/parse_full_model.h"
#include "core/support/rough.h"
#include "study/analysis/arrays/array_parameters.h"
#include "study/analysis/arrays/array_setup.h"
#include "study/analysis/arrays/regressors.h"
#include "study/analysis/prepare.h"
#include "study/analysis/vocabulary.h"

namespace imunoise::study {
namespace {

Result<void> check(const Regression& regression, const std::vector<Series>& channels,
                   const Model& written, const ArrayLayout& layout) {
  if (channels.front().replicates.size() != 1) {
    return fail(
        "mixed: give one recording without gaps or missing values; several pieces would each have "
        "constants of their own");
  }
  const Series& first = regression.responses.front();
  for (const Series& one : regression.responses) {
    const Quantity quantity = one.replicates.front().quantity();
    if (quantity != first.replicates.front().quantity()) {
      return fail(
          fmt::format("{} and {} are different quantities: choose the series with --channel",
                      first.channel, one.channel));
    }
  }
  const Eigen::MatrixXd& response = regression.data.response;
  for (Eigen::Index i = 0; i < response.cols(); ++i) {
    if ((response.col(i).array() != response(0, i)).any()) continue;
    return fail(fmt::format("{} never changes: leave it out with --channel",
                            regression.responses[static_cast<std::size_t>(i)].channel));
  }
  if (!has_likelihood(expand(written, layout)))
    return fail("model: DR is not noise here; remove it and add --regress time");
  const std::size_t scales = Scales::for_samples(static_cast<std::size_t>(response.rows())).size();
  if (free_parameters(written) > scales) {
    return fail(
        fmt::format("model: {} has {} free parameters a series, but there are only {} scales",
                    print(written), free_parameters(written), scales));
  }
  return {};
}

v1::CoefficientEstimate message(const CoefficientEstimate& from) {
  v1::CoefficientEstimate out;
  out.set_value(from.value);
  out.set_standard_error(from.standard_error);
  out.set_lower(from.lower);
  out.set_upper(from.upper);
  out.set_p_value(from.p_value);
  return out;
}

void add_explained(const MixedRegression& found, const Model& written,
                   const std::vector<Series>& responses, v1::MixedReport& out) {
  for (std::size_t i = 0; i < responses.size(); ++i) {
    v1::SensorBudget& row = *out.add_explained();
    row.set_sensor(responses[i].channel);
    for (std::size_t t = 0; t <= written.terms.size(); ++t) {
      v1::TermShare& share = *row.add_terms();
      share.set_term(t == 0 ? "regressors" : array_label(written, t - 1));
      share.set_share(found.explained(static_cast<Eigen::Index>(i), static_cast<Eigen::Index>(t)));
    }
  }
}

std::string summary_of(const v1::MixedReport& report) {
  std::string out;
  for (const v1::RegressionCoefficient& one : report.coefficients()) {
    const std::string chance = chance_words(one.gls().p_value());
    out += one.significant()
               ? fmt::format("{} has an effect ({}). ", one.regressor(), chance)
               : fmt::format("An effect of {} is not shown ({}). ", one.regressor(), chance);
    if (!one.significant() && one.naive().p_value() <= kLevel) {
      out += fmt::format(
          "Had the samples been taken as independent, it would have seemed to have one: "
          "its error is {} times larger than that. ",
          rough(one.gls().standard_error() / one.naive().standard_error()));
    }
  }
  out.pop_back();
  return out;
}

}  // namespace

Result<v1::MixedReport> mixed_series(const std::vector<Series>& channels,
                                     const MixedSeriesOptions& options, const Progress& progress) {
  if (auto enough = check_bootstrap(options.regression.bootstraps); !enough)
    return tl::unexpected(enough.error());
  const Result<Regression> regression = read_regressors(channels, options.regressors);
  if (!regression) return tl::unexpected(regression.error());
  const auto& [responses, names, units, data] = *regression;
  const Result<Model> written = parse_noise_model(
      options.model ? *options.model : kDefaultMixedModel, data.rate, grammar_of_arrays());
  if (!written) return tl::unexpected(written.error());
  const Result<ArrayLayout> layout = layout_of(responses, options.groups, *written);
  if (!layout) return tl::unexpected(layout.error());
  if (auto good = check(*regression, channels, *written, *layout); !good)
    return tl::unexpected(good.error());

  const MixedRegression found =
      mixed_regression(*written, *layout, data, options.regression, progress);
  if (progress.stopped()) return fail("stopped");

  v1::MixedReport out;
  out.set_unit(std::string(si_symbol(responses.front().replicates.front().quantity())));
  out.set_rate_hz(data.rate.value);
  for (const Series& one : responses) out.add_series(one.channel);
  out.set_samples(static_cast<std::uint64_t>(data.response.rows()));
  out.set_model(print(*written));
  out.set_termination(std::string(describe(found.noise.termination)));
  out.set_estimator(likelihood_estimator("MiGMWM"));
  out.set_bootstraps(options.regression.bootstraps);
  out.set_seed(options.regression.seed);
  for (std::size_t j = 0; j < names.size(); ++j) {
    v1::RegressionCoefficient& to = *out.add_coefficients();
    to.set_regressor(names[j]);
    to.set_unit(units[j]);
    *to.mutable_gls() = message(found.gls[j]);
    if (!found.robust.empty()) *to.mutable_robust() = message(found.robust[j]);
    *to.mutable_naive() = message(found.naive[j]);
    to.set_significant(found.gls[j].p_value <= kLevel);
  }
  for (std::size_t i = 0; i < responses.size(); ++i) {
    v1::SeriesConstant& to = *out.add_constants();
    to.set_series(responses[i].channel);
    // The samples were taken less their first one.
    to.set_value(found.constants(static_cast<Eigen::Index>(i)) +
                 responses[i].replicates.front().value(0));
  }
  for (v1::ArrayParameter& one :
       array_parameters(found.noise, *written, responses, options.regression.confidence))
    *out.add_parameters() = std::move(one);
  add_explained(found, *written, responses, out);
  out.set_summary(summary_of(out));
  if (!options.model) out.add_notes(default_model_note("was fitted", kDefaultMixedModel));
  if (options.regression.bootstraps == 0)
    out.add_notes(
        "Without a bootstrap (--bootstrap) p values are those of the normal law, which are too "
        "small in short series.");
  return out;
}

}  // namespace imunoise::study
