#include "study/analysis/prepare.h"

#include <fmt/format.h>

#include <algorithm>

namespace imunoise::study {

namespace {

// Some process has a power that is not given as 0, and is no ramp, which one number describes.
bool is_random(const Model& model) {
  return std::any_of(model.terms.begin(), model.terms.end(), [](const Term& term) {
    const bool none = term.given[0] && values(term.process)[0] == 0.0;
    return !none && !std::holds_alternative<RateRamp>(term.process);
  });
}

}  // namespace

std::string default_model_note(std::string_view done, std::string_view model) {
  return fmt::format("No model was named: {} {}. Another one may fit better.", model, done);
}

Result<void> check_replicates(const Series& series, const std::vector<WaveletVariance>& measured) {
  for (std::size_t k = 0; k < measured.size(); ++k) {
    const Eigen::ArrayXd& own = measured[k].variance;
    if ((own == 0.0).all() || series.replicates[k].never_changes()) {
      return fail(fmt::format(
          "{}: {} never changes, so it has no noise to model; check that the channel is in use. "
          "--channel chooses others",
          series.names[k], series.channel));
    }
    for (std::size_t other = 0; other < k; ++other) {
      const Eigen::ArrayXd& before = measured[other].variance;
      if (own.size() == before.size() && (own == before).all()) {
        return fail(fmt::format("{}: {} and {} have the same samples; name each recording once",
                                series.channel, series.names[other], series.names[k]));
      }
    }
  }
  return {};
}

Result<void> can_be_fitted(const Model& model, const std::vector<WaveletVariance>& measured) {
  if (!is_random(model)) {
    return fail(
        "model: it has no noise, and a ramp or a power of 0 explains no random error; add a "
        "process such as WN");
  }
  std::size_t scales = 0;
  for (const WaveletVariance& wv : measured) scales = std::max(scales, wv.scales.size());
  if (free_parameters(model) <= scales) return {};
  return fail(
      fmt::format("model: {} has {} free parameters, but the recording has only {} scales; take a "
                  "smaller model, record longer, or use more scales per octave",
                  print(model), free_parameters(model), scales));
}

Result<std::vector<WaveletVariance>> measured_replicates(const Series& series,
                                                         const MeasureOptions& options,
                                                         const Progress& progress) {
  auto out = measure(series, options, progress);
  if (!out) return out;
  if (auto sound = check_replicates(series, *out); !sound) return tl::unexpected(sound.error());
  return out;
}

Result<Prepared> prepare(const Series& series, std::string_view text, const Grammar& grammar,
                         const MeasureOptions& options, const Progress& progress) {
  const auto model = parse_full_model(text, series.replicates.front().rate(), grammar);
  if (!model) return tl::unexpected(model.error());
  auto left = take_out_effects(series, *model, progress.part(0.0, 0.4));
  if (!left) return tl::unexpected(left.error());
  auto measured = measured_replicates(left->series, options, progress.part(0.4, 1.0));
  if (!measured) return tl::unexpected(measured.error());
  if (auto sound = can_be_fitted(left->noise, *measured); !sound)
    return tl::unexpected(sound.error());
  return Prepared{std::move(*left), std::move(*measured)};
}

std::size_t free_parameters(const Model& model) {
  std::size_t out = 0;
  for (const Term& term : model.terms) {
    out += static_cast<std::size_t>(std::count(term.given.begin(), term.given.end(), false));
  }
  return out;
}

}  // namespace imunoise::study
