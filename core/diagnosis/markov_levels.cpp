#include "core/diagnosis/markov_levels.h"

#include <algorithm>
#include <cmath>

#include "core/spectrum/cosine_transform.h"

namespace imunoise {
namespace {

using Index = Eigen::Index;

// Of a normal distribution, but for a constant.
double log_density(double x, double mean, double deviation) {
  const double z = (x - mean) / deviation;
  return -0.5 * z * z - std::log(deviation);
}

// Values that lie close to each other, as one.
struct Bin {
  double mean = 0.0;
  double count = 0.0;
};

std::vector<Bin> binned(const std::vector<double>& x, double centre, double deviation) {
  constexpr double kWidth = 1.0 / 256.0;  // standard deviations
  constexpr double kReach = 8.0;          // what lies further out is in the last bins
  constexpr auto kBins = static_cast<std::size_t>(2.0 * kReach / kWidth);
  std::vector<Bin> out(kBins);
  for (const double one : x) {
    const double at = ((one - centre) / deviation + kReach) / kWidth;
    Bin& bin = out[static_cast<std::size_t>(std::clamp(at, 0.0, static_cast<double>(kBins - 1)))];
    bin.count += 1.0;
    bin.mean += (one - bin.mean) / bin.count;
  }
  std::erase_if(out, [](const Bin& one) { return one.count == 0.0; });
  return out;
}

// Log-likelihood of two normal distributions of one width over that of a single one: by EM from the
// two halves.
double mixture_gain(const std::vector<double>& x) {
  const auto n = static_cast<double>(x.size());
  double mean = 0.0;
  for (const double one : x) mean += one / n;
  double variance = 0.0;
  for (const double one : x) variance += (one - mean) * (one - mean) / n;
  if (!(variance > 0.0)) return 0.0;
  const double wide = std::sqrt(variance);
  const std::vector<Bin> bins = binned(x, mean, wide);
  double low = mean - wide;
  double high = mean + wide;
  double share = 0.5;
  double width = 0.5 * wide;
  double gain = 0.0;
  for (int round = 0; round < 200; ++round) {
    double weight = 0.0;
    double sum_low = 0.0;
    double sum_high = 0.0;
    double squares = 0.0;
    double before = gain;
    gain = 0.0;
    for (const auto& [one, count] : bins) {
      const double at_low = std::log1p(-share) + log_density(one, low, width);
      const double at_high = std::log(share) + log_density(one, high, width);
      const double most = std::max(at_low, at_high);
      const double both = std::exp(at_low - most) + std::exp(at_high - most);
      const double part = std::exp(at_high - most) / both;
      weight += count * part;
      sum_low += count * (1.0 - part) * one;
      sum_high += count * part * one;
      squares +=
          count * ((1.0 - part) * (one - low) * (one - low) + part * (one - high) * (one - high));
      gain += count * (most + std::log(both) - log_density(one, mean, wide));
    }
    if (weight < 2.0 || weight > n - 2.0) return 0.0;
    share = weight / n;
    low = sum_low / (n - weight);
    high = sum_high / weight;
    width = std::max(std::sqrt(squares / n), 0.05 * wide);
    if (round > 0 && std::abs(gain - before) < 1e-6) break;
  }
  return gain;
}

}  // namespace

double two_level_gain(const Regression& regression, const JointFit& fit) {
  const Model& noise = fit.model.noise;
  const auto markov = std::find_if(noise.terms.rbegin(), noise.terms.rend(), [](const Term& term) {
    const auto* one = std::get_if<Ar1>(&term.process);
    return one != nullptr && one->phi > 0.0 && one->sigma2 > 0.0;
  });
  if (markov == noise.terms.rend()) return 0.0;
  const Model alone{{*markov}};
  const double tau = -1.0 / std::log(std::get<Ar1>(markov->process).phi);
  std::vector<double> levels;
  for (std::size_t k = 0; k < regression.subject().replicates(); ++k) {
    const Eigen::VectorXd left = regression.residual_cosines(fit.effects.value, k);
    const Index n = left.size() + 1;
    const Eigen::ArrayXd share = spectrum_of_cosines(alone, n) / spectrum_of_cosines(noise, n);
    const Eigen::VectorXd course = inverse_cosine_transform((left.array() * share).matrix());
    const auto stride = std::max<Index>(1, static_cast<Index>(2.0 * tau));
    for (Index t = stride / 2; t < n; t += stride) levels.push_back(course(t));
  }
  constexpr std::size_t kFewest = 20;
  return levels.size() < kFewest ? 0.0 : mixture_gain(levels);
}

}  // namespace imunoise
