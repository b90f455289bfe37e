#include "core/effects/distributions/disturbed_samples.h"

#include <algorithm>
#include <cmath>
#include <map>
#include <numeric>

#include "core/effects/distributions/contamination.h"
#include "core/spectrum/cosine_transform.h"
#include "core/support/distributions.h"
#include "core/support/parallel.h"

namespace imunoise {
namespace {

using Index = Eigen::Index;

// 1/variance of the size of a disturbance of one sample, the same at each sample of a replicate.
double information(const Current& current, std::size_t k) {
  return (1.0 / current.spectrum[k]).mean();
}

DisturbedSamples standing_out(const Current& current, double above) {
  const std::size_t count = current.weighted.size();
  DisturbedSamples out;
  out.places.resize(count);
  out.sizes.resize(count);
  for (std::size_t k = 0; k < count; ++k) {
    const Eigen::VectorXd& u = current.weighted[k];
    const double known = information(current, k);
    const double least = above * std::sqrt(known);
    for (Index t = 0; t < u.size(); ++t) {
      const double size = std::abs(u(t));
      if (size < least) continue;
      const bool peak = (t == 0 || size >= std::abs(u(t - 1))) &&
                        (t + 1 == u.size() || size > std::abs(u(t + 1)));
      if (!peak) continue;
      out.places[k].push_back(t);
      out.sizes[k].push_back(u(t) / known);
    }
  }
  return out;
}

// Both together. A sample in both has the sum of the sizes: the second is what the first left.
DisturbedSamples together(const DisturbedSamples& one, const DisturbedSamples& other) {
  DisturbedSamples out;
  for (std::size_t k = 0; k < one.places.size(); ++k) {
    std::map<Index, double> all;
    for (const DisturbedSamples* from : {&one, &other}) {
      for (std::size_t i = 0; i < from->places[k].size(); ++i)
        all[from->places[k][i]] += from->sizes[k][i];
    }
    auto& places = out.places.emplace_back();
    auto& sizes = out.sizes.emplace_back();
    for (const auto& [place, size] : all) {
      places.push_back(place);
      sizes.push_back(size);
    }
  }
  return out;
}

// The threshold that noise of this many samples passes once in 20 recordings.
double rare(const Subject& subject) {
  double samples = 0.0;
  for (const SharedVector& x : subject.samples) samples += static_cast<double>(x.size());
  constexpr double kOnceIn = 20.0;
  return normal_quantile(1.0 - 0.5 / (kOnceIn * samples));
}

// The law that those beyond a threshold tell; absent where there are none, or none wider than
// noise.
std::optional<Contamination> law_of(const Current& left, const DisturbedSamples& all,
                                    double above) {
  double count = 0.0;
  double squares = 0.0;
  double samples = 0.0;
  for (std::size_t k = 0; k < all.sizes.size(); ++k) {
    const double known = information(left, k);
    for (const double size : all.sizes[k]) {
      const double square = size * size * known;
      if (square < above * above) continue;
      ++count;
      squares += square;
    }
    samples += static_cast<double>(left.weighted[k].size());
  }
  if (count == 0.0) return std::nullopt;
  return contamination_of(count, samples, above, squares / count);
}

// The threshold where none is given.
double threshold_of(const Current& left, const DisturbedSamples& all) {
  const double seldom = rare(left.subject());
  const auto law = law_of(left, all, seldom);
  return law ? std::clamp(law->even_chance(), kLeastDisturbed, seldom) : seldom;
}

// What taking those of each replicate out costs, nats, under the noise that is left. As much as one
// gains that noise has once in 20 recordings. Where there are many, less: as much as makes the gain
// that of a mixture of normal distributions whose share and width they tell (contamination.h), at
// the price of these two numbers.
std::vector<double> prices(const Current& left, const DisturbedSamples& all, double above) {
  const std::size_t replicates = all.places.size();
  const double seldom = std::max(above, rare(left.subject()));
  std::vector<double> out(replicates);
  for (std::size_t k = 0; k < replicates; ++k)
    out[k] = 0.5 * seldom * seldom * static_cast<double>(all.places[k].size());
  const auto law = law_of(left, all, above);
  if (!law) return out;
  const auto count = static_cast<double>(all.count());
  std::vector<double> of_mixture(replicates);
  for_each_index(replicates, [&](std::size_t k) {
    const double deviations = std::sqrt(information(left, k));
    double price = std::log(count + 1.0) * static_cast<double>(all.places[k].size()) / count;
    for (const double size : all.sizes[k]) {
      const double z = size * deviations;
      price += 0.5 * z * z - law->log_ratio(z);
    }
    for (const double u : left.weighted[k]) price -= law->log_ratio(u / deviations);
    of_mixture[k] = price;
  });
  const auto sum = [](const std::vector<double>& each) {
    return std::accumulate(each.begin(), each.end(), 0.0);
  };
  return sum(of_mixture) < sum(out) ? of_mixture : out;
}

// The subject with them taken out. Sizes are estimates, so the noise beneath them stays.
std::shared_ptr<Subject> without(const Subject& subject, const DisturbedSamples& all) {
  auto out = std::make_shared<Subject>(subject);
  for_each_index(out->samples.size(), [&](std::size_t k) {
    if (all.places[k].empty()) return;
    Eigen::VectorXd samples = out->samples[k];
    for (std::size_t i = 0; i < all.places[k].size(); ++i)
      samples(all.places[k][i]) -= all.sizes[k][i];
    samples.array() -= samples.mean();
    out->cosines[k] = cosine_transform(samples);
    out->samples[k] = std::move(samples);
  });
  out->own_nats.resize(out->samples.size(), 0.0);
  return out;
}

}  // namespace

std::size_t DisturbedSamples::count() const {
  return std::accumulate(places.begin(), places.end(), std::size_t{0},
                         [](std::size_t sum, const auto& one) { return sum + one.size(); });
}

Undisturbed undisturbed(const Current& current, std::optional<double> above) {
  constexpr int kMostTurns = 16;
  const Subject& subject = current.subject();
  Undisturbed out{.subject = std::make_shared<Subject>(subject),
                  .above = above.value_or(rare(subject))};
  out.taken_out = standing_out(current, out.above);
  if (out.taken_out.count() == 0) return out;
  for (int turn = 1;; ++turn) {
    out.subject = without(subject, out.taken_out);
    const Regression regression = current.regression.on(out.subject);
    const JointFit fit =
        joint_fit(regression, current.fit.model.noise, {}, Begin::kAnywhere, current.fit.own_noise);
    const Current left = current_of(regression, fit);
    out.gain_nats = fit.log_likelihood - current.fit.log_likelihood;
    if (!above) out.above = threshold_of(left, out.taken_out);
    const DisturbedSamples more = standing_out(left, out.above);
    if (more.count() > 0 && turn < kMostTurns) {
      out.taken_out = together(out.taken_out, more);
      continue;
    }
    const std::vector<double> price = prices(left, out.taken_out, out.above);
    for (std::size_t k = 0; k < price.size(); ++k) out.subject->own_nats[k] += price[k];
    return out;
  }
}

}  // namespace imunoise
