// outliers: single samples that something disturbed.

#include <cmath>
#include <numeric>

#include "core/effect/columns.h"
#include "core/effects/distributions/contamination.h"
#include "core/effects/distributions/power_spell.h"
#include "core/effects/distributions/tails.h"
#include "core/effects/draws.h"
#include "core/search/search_view.h"
#include "core/spectrum/cosine_transform.h"
#include "core/support/distributions.h"
#include "core/support/parallel.h"

namespace imunoise::effects {

const Effect& outliers();

namespace {

using Index = Eigen::Index;

enum OutliersParameter : std::size_t { kOutliersAbove, kOutliersShare, kOutliersSize };

constexpr double kLeastAbove = 3.0;

std::string_view outliers_fault(const EffectTerm& term) {
  if (term[kOutliersAbove] >= kLeastAbove) return {};
  return "above is at least 3 standard deviations: less is noise";
}

// Samples that stand out from what the noise before and after them makes likely.
struct Outliers : Found {
  std::vector<std::vector<Index>> places;  // of each replicate
  std::vector<std::vector<double>> sizes;  // unit
  double above = 0.0;                      // the threshold
  double gain_nats = 0.0;                  // log-likelihood that taking them out gains
  std::size_t count = 0;
};

// Those beyond `above` standard deviations of what single samples can be told by (the matched
// filter of an impulse under the noise); of neighbours, the largest.
Outliers find_outliers(const Current& current, double above) {
  const std::size_t count = current.weighted.size();
  Outliers out;
  out.places.resize(count);
  out.sizes.resize(count);
  out.above = above;
  for (std::size_t k = 0; k < count; ++k) {
    const Eigen::VectorXd& u = current.weighted[k];
    const double information = (1.0 / current.spectrum[k]).mean();
    const double least = above * std::sqrt(information);
    for (Index t = 0; t < u.size(); ++t) {
      const double size = std::abs(u(t));
      if (size < least) continue;
      const bool peak = (t == 0 || size >= std::abs(u(t - 1))) &&
                        (t + 1 == u.size() || size > std::abs(u(t + 1)));
      if (!peak) continue;
      out.places[k].push_back(t);
      out.sizes[k].push_back(u(t) / information);
      out.gain_nats += 0.5 * size * size / information;
      ++out.count;
    }
  }
  return out;
}

// The threshold that noise of this many samples passes once in 20 recordings.
double outlier_threshold(const Subject& subject) {
  double samples = 0.0;
  for (const SharedVector& x : subject.samples) samples += static_cast<double>(x.size());
  constexpr double kOnceIn = 20.0;
  return normal_quantile(1.0 - 0.5 / (kOnceIn * samples));
}

double sum_of_squares(const std::vector<double>& sizes) {
  double out = 0.0;
  for (const double size : sizes) out += size * size;
  return out;
}

// The law that they tell; absent where there are none, or none wider than noise.
std::optional<Contamination> law_of(const Current& current, const Outliers& outliers) {
  if (outliers.count == 0) return std::nullopt;
  double squares = 0.0;
  double samples = 0.0;
  for (std::size_t k = 0; k < outliers.sizes.size(); ++k) {
    squares += sum_of_squares(outliers.sizes[k]) * (1.0 / current.spectrum[k]).mean();
    samples += static_cast<double>(current.weighted[k].size());
  }
  const auto count = static_cast<double>(outliers.count);
  return contamination_of(count, samples, outliers.above, squares / count);
}

// The deviations of a replicate that are not taken out: of the matched filter, in its standard
// deviations.
Eigen::ArrayXd deviations_left(const Current& current, const Subject& without, std::size_t k) {
  const Eigen::VectorXd left =
      current.cosines[k] + without.cosines[k] - current.subject().cosines[k];
  const Eigen::ArrayXd weights = 1.0 / current.spectrum[k];
  return rough_inverse_cosine_transform((left.array() * weights).matrix()).array() /
         std::sqrt(weights.mean());
}

// What taking the outliers of each replicate out costs, nats. As much as an outlier gains that
// noise has once in 20 recordings. Where there are many, less: as much as makes the gain that of a
// mixture of normal distributions whose share and width the outliers tell (contamination.h), at the
// price of these two numbers.
std::vector<double> prices(const Current& current, const Outliers& outliers,
                           const Subject& without) {
  const std::size_t replicates = outliers.places.size();
  const double rare = std::max(outliers.above, outlier_threshold(current.subject()));
  std::vector<double> out(replicates);
  for (std::size_t k = 0; k < replicates; ++k)
    out[k] = 0.5 * rare * rare * static_cast<double>(outliers.places[k].size());
  const auto count = static_cast<double>(outliers.count);
  const auto law = law_of(current, outliers);
  if (!law) return out;
  std::vector<double> of_mixture(replicates);
  for_each_index(replicates, [&](std::size_t k) {
    const double information = (1.0 / current.spectrum[k]).mean();
    double price = std::log(count + 1.0) * static_cast<double>(outliers.places[k].size()) / count;
    for (const double size : outliers.sizes[k]) {
      const double z = size * std::sqrt(information);
      price += 0.5 * z * z - law->log_ratio(z);
    }
    const Eigen::ArrayXd left = deviations_left(current, without, k);
    for (const double z : left) price -= law->log_ratio(z);
    of_mixture[k] = price;
  });
  const auto sum = [](const std::vector<double>& all) {
    return std::accumulate(all.begin(), all.end(), 0.0);
  };
  return sum(of_mixture) < sum(out) ? of_mixture : out;
}

// The subject with them taken out. Sizes are estimates, so the noise beneath them stays.
std::shared_ptr<Subject> without(const Current& current, const Outliers& outliers) {
  auto out = std::make_shared<Subject>(current.subject());
  out->own_nats.resize(out->samples.size(), 0.0);
  if (outliers.count == 0) return out;
  for_each_index(out->samples.size(), [&](std::size_t k) {
    if (outliers.places[k].empty()) return;
    Eigen::VectorXd samples = out->samples[k];
    for (std::size_t i = 0; i < outliers.places[k].size(); ++i)
      samples(outliers.places[k][i]) -= outliers.sizes[k][i];
    samples.array() -= samples.mean();
    out->cosines[k] = cosine_transform(samples);
    out->samples[k] = std::move(samples);
  });
  const std::vector<double> price = prices(current, outliers, *out);
  for (std::size_t k = 0; k < price.size(); ++k) out->own_nats[k] += price[k];
  return out;
}

std::shared_ptr<const Subject> without_outliers(const EffectTerm& term, const Current& current) {
  auto found = std::make_shared<const Outliers>(find_outliers(current, term[kOutliersAbove]));
  auto out = without(current, *found);
  out->keep(term, std::move(found));
  return out;
}

// Their share of the samples, with the error of a count, and the root mean square of their sizes.
std::vector<ReportedNumber> fitted_outliers(const FittedEffect& effect) {
  const auto* const found = effect.subject().found_by<Outliers>(effect.term());
  if (found == nullptr) return {};
  double samples = 0.0;
  double squares = 0.0;
  for (std::size_t k = 0; k < found->sizes.size(); ++k) {
    samples += static_cast<double>(effect.subject().length(k));
    squares += sum_of_squares(found->sizes[k]);
  }
  const auto count = static_cast<double>(found->count);
  return {with_error({"share", count / samples, "1"}, std::sqrt(count) / samples),
          {"size", found->count > 0 ? std::sqrt(squares / count) : 0.0,
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
  const Subject& subject = view.subject();
  double above = outlier_threshold(subject);
  Outliers found = find_outliers(view.current(), above);
  // Where there are many, smaller ones are outliers more likely than not.
  if (const auto law = law_of(view.current(), found)) {
    const double likely = law->even_chance();
    if (likely < above) {
      above = std::max(likely, kLeastAbove);
      found = find_outliers(view.current(), above);
    }
  }
  double samples = 0.0;
  for (const SharedVector& x : subject.samples) samples += static_cast<double>(x.size());
  const auto count = static_cast<double>(found.count);
  // So many places out of all samples: about log(samples^count / count!).
  return {{.cause = "outliers",
           .added = EffectTerm(outliers(), "", {{"above", above}}),
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
