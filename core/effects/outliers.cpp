// outliers: single samples that something disturbed.

#include <cmath>

#include "core/effect/columns.h"
#include "core/effects/distributions/disturbed_samples.h"
#include "core/effects/distributions/power_spell.h"
#include "core/effects/distributions/tails.h"
#include "core/effects/draws.h"
#include "core/search/search_view.h"

namespace imunoise::effects {

const Effect& outliers();

namespace {

enum OutliersParameter : std::size_t { kOutliersAbove, kOutliersShare, kOutliersSize };

std::string_view outliers_fault(const EffectTerm& term) {
  if (term[kOutliersAbove] >= kLeastDisturbed) return {};
  return "above is at least 3 standard deviations: less is noise";
}

std::shared_ptr<const Subject> without_outliers(const EffectTerm& term, const Current& current) {
  Undisturbed out = undisturbed(current, term[kOutliersAbove]);
  out.subject->keep(term, std::make_shared<const DisturbedSamples>(std::move(out.taken_out)));
  return out.subject;
}

// Their share of the samples, with the error of a count, and the root mean square of their sizes.
std::vector<ReportedNumber> fitted_outliers(const FittedEffect& effect) {
  const auto* const found = effect.subject().found_by<DisturbedSamples>(effect.term());
  if (found == nullptr) return {};
  double samples = 0.0;
  double squares = 0.0;
  for (std::size_t k = 0; k < found->sizes.size(); ++k) {
    samples += static_cast<double>(effect.subject().length(k));
    for (const double size : found->sizes[k]) squares += size * size;
  }
  const auto count = static_cast<double>(found->count());
  return {with_error({"share", count / samples, "1"}, std::sqrt(count) / samples),
          {"size", count > 0.0 ? std::sqrt(squares / count) : 0.0,
           unit_of(effect.term(), effect.subject())}};
}

void simulate_outliers(const EffectTerm& term, const SimulatedReplicate& at,
                       Eigen::VectorXd& samples) {
  for (double& x : samples) {
    if (uniform_number(at.random) < term[kOutliersShare])
      x += std::copysign(term[kOutliersSize], at.random.normal());
  }
}

Suggestions search_outliers(const SearchView& view) {
  const Undisturbed found = undisturbed(view.current());
  double samples = 0.0;
  for (const SharedVector& x : view.subject().samples) samples += static_cast<double>(x.size());
  const auto count = static_cast<double>(found.taken_out.count());
  // So many places out of all samples: about log(samples^count / count!).
  return {{.cause = "outliers",
           .added = EffectTerm(outliers(), "", {{"above", found.above}}),
           .score_nats = found.gain_nats,
           .dof = count,
           .search = {.log_places = count * std::log(samples) - std::lgamma(count + 1.0) +
                                    log_number(count)}}};
}

double beyond(const std::vector<Eigen::VectorXd>& white, double above) {
  double out = 0.0;
  for (const Eigen::VectorXd& one : white)
    out += static_cast<double>((one.array().abs() > above).count());
  return out;
}

// Those that only noise of another power for a while makes are no outliers.
void review_outliers(const Current& current, TriedTerm& tried) {
  const Innovations all = innovations(current.regression, current.fit);
  const double above = (*tried.term())[kOutliersAbove];
  const double as_they_are = beyond(all.white, above);
  if (as_they_are > 0.0)
    tried.likelihood_gain *= std::min(1.0, beyond(beside_spells(all.white), above) / as_they_are);
  const SizeCounts sizes = count_sizes(all.white);
  if (!compare_tails(sizes).rules_out_student()) tried.could_be.push_back("heavy_tails");
}

void outlier_numbers(const TriedTerm& tried, std::vector<ReportedNumber>& first,
                     std::vector<ReportedNumber>&) {
  first.push_back({"count", tried.suggestion.dof, "1"});
}

}  // namespace

const Effect& outliers() {
  static const Effect kOutliers{
      .name = "outliers",
      .title = "outliers",
      .meaning = "Takes out single samples that stand out from their neighbours.",
      .parameters = {{.name = "above",
                      .meaning = "smallest size of an outlier, in standard deviations",
                      .unit = "1",
                      .required = true,
                      .rounding = Rounding::kFourDigits},
                     {.name = "share",
                      .meaning = "share of the samples that are disturbed",
                      .unit = "1",
                      .upper = 1.0,
                      .reported = "share",
                      .truth = true},
                     {.name = "size",
                      .meaning = "size of each disturbance; its sign is random",
                      .reported = "size",
                      .truth = true}},
      .causes = {{.id = "outliers",
                  .title = "outliers",
                  .physics = "Single samples are disturbed: interference, or errors of the "
                             "transfer.",
                  .record_next = "the raw words with their checksums",
                  .looks_like = {"white_noise", "modulated_variance"},
                  .family = "outliers"}},
      .fault = outliers_fault,
      .cleaned = without_outliers,
      .simulate = simulate_outliers,
      .search = search_outliers,
      .review = review_outliers,
      .numbers = fitted_outliers,
      .more_numbers = outlier_numbers,
  };
  return kOutliers;
}

}  // namespace imunoise::effects
