#include "tests/hidden_effects/scoring/statistics.h"

#include <algorithm>
#include <cmath>
#include <cstdio>

#include "core/support/distributions.h"
#include "core/support/roots.h"

namespace imunoise::hidden {
namespace {

constexpr double kOneSided = 0.05;
constexpr double kFamilies = 20.0;  // kinds of effect in the catalogue

// P(X ≤ hits) of a binomial law.
double binomial_cdf(std::size_t hits, std::size_t count, double p) {
  const double n = static_cast<double>(count);
  double sum = 0.0;
  for (std::size_t k = 0; k <= hits; ++k) {
    const double x = static_cast<double>(k);
    sum += std::exp(std::lgamma(n + 1.0) - std::lgamma(x + 1.0) - std::lgamma(n - x + 1.0) +
                    x * std::log(p) + (n - x) * std::log1p(-p));
  }
  return sum;
}

// The p at which the decreasing cdf(p) is `level`.
double solve_p(std::size_t hits, std::size_t count, double level) {
  constexpr double kEdge = 1e-12;
  const auto above = [&](double p) { return binomial_cdf(hits, count, p) - level; };
  if (above(1.0 - kEdge) > 0.0) return 1.0;
  return root_between(above, kEdge, 1.0 - kEdge);
}

// Places that a search for this effect has to look at.
double places(const HiddenEffect& effect, double samples, double replicates) {
  if (effect.id == "mains_alias") return 8.0;  // 50 and 60 Hz, overtones
  if (effect.family == Family::kLine) return 0.5 * samples;
  if (effect.id == "step" || effect.id == "telegraph") return samples * replicates;
  if (effect.id == "resonance") return 100.0;          // frequencies × widths
  if (effect.family == Family::kWitness) return 20.0;  // five channels, four forms
  return 10.0;                                         // time constants
}

}  // namespace

double Share::value() const {
  return count == 0 ? 0.0 : static_cast<double>(hits) / static_cast<double>(count);
}

double Share::lower() const { return hits == 0 ? 0.0 : solve_p(hits - 1, count, 1.0 - kOneSided); }

double Share::upper() const { return hits == count ? 1.0 : solve_p(hits, count, kOneSided); }

std::string to_string(const Share& share) {
  char text[64];
  std::snprintf(text, sizeof text, "%zu/%zu = %.0f %%", share.hits, share.count,
                100.0 * share.value());
  return text;
}

std::optional<double> median(std::vector<double> values) {
  if (values.empty()) return std::nullopt;
  const auto middle = values.begin() + static_cast<std::ptrdiff_t>(values.size() / 2);
  std::nth_element(values.begin(), middle, values.end());
  return *middle;
}

std::optional<double> strength_at_90(std::vector<std::pair<double, Share>> found) {
  struct Block {
    double from;  // δ
    double to;
    Share share;
  };
  std::vector<Block> blocks;
  for (const auto& [delta, share] : found) {
    blocks.push_back({delta, delta, share});
    while (blocks.size() > 1 &&
           blocks.back().share.value() < blocks[blocks.size() - 2].share.value()) {
      Block& before = blocks[blocks.size() - 2];
      before.to = blocks.back().to;
      before.share.hits += blocks.back().share.hits;
      before.share.count += blocks.back().share.count;
      blocks.pop_back();
    }
  }
  const Block* before = nullptr;
  for (const Block& block : blocks) {
    const double here = block.share.value();
    if (here >= 0.9 && before == nullptr) return block.from;
    if (here >= 0.9) {
      const double part = (0.9 - before->share.value()) / (here - before->share.value());
      return before->to + (block.from - before->to) * part;
    }
    before = &block;
  }
  return std::nullopt;
}

double oracle_at_90(const HiddenEffect& effect, std::size_t samples, std::size_t replicates) {
  const double tail = 0.05 / kFamilies /
                      places(effect, static_cast<double>(samples), static_cast<double>(replicates));
  const double found = normal_quantile(0.9);
  if (effect.family != Family::kLine) {
    const bool signless = effect.family == Family::kShort || effect.family == Family::kSlow;
    return normal_quantile(1.0 - (signless ? tail : 0.5 * tail)) + found;
  }
  // The power of lines of unknown phase: χ² with two degrees of freedom each, of mean dof + δ² and
  // variance 2·dof + 4δ² when they are there.
  const double dof = effect.id == "harmonics" ? 6.0 : 2.0;
  const double threshold = chi_square_quantile(1.0 - tail, dof);
  return root_between(
      [&](double delta) {
        return dof + delta * delta - threshold - found * std::sqrt(2.0 * dof + 4.0 * delta * delta);
      },
      0.0, 100.0);
}

}  // namespace imunoise::hidden
