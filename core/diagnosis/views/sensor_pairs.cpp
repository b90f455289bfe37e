#include "core/diagnosis/views/sensor_pairs.h"

#include <algorithm>
#include <cmath>

#include "core/spectrum/bands.h"
#include "core/support/parallel.h"

namespace imunoise {
namespace {

using Index = Eigen::Index;

constexpr Index kFirst = 8;        // coefficients of a replicate: below, there are too few
constexpr double kAgreeing = 3.0;  // standard deviations: a neighbour of a stretch

// Half octaves of the coefficients of a replicate of n samples: where each begins, and the end, in
// cycles per sample.
std::vector<double> half_octaves(Index n) {
  std::vector<double> out;
  const double per_place = 0.5 / static_cast<double>(n);
  for (double at = static_cast<double>(kFirst); at < static_cast<double>(n - 1);
       at *= std::sqrt(2.0))
    out.push_back(per_place * static_cast<double>(std::lround(at) + 1));
  out.push_back(0.5);
  return out;
}

// Sums over the replicates of one half octave.
struct Products {
  double first = 0.0;
  double second = 0.0;
  double both = 0.0;
  double count = 0.0;
  double correlation() const {
    const double squares = first * second;
    return squares > 0.0 ? both / std::sqrt(squares) : 0.0;
  }
  // Fisher's z; the mean is known to be zero.
  double sigma() const {
    const double r = std::clamp(correlation(), -1.0 + 1e-12, 1.0 - 1e-12);
    return count > 3.0 ? std::atanh(r) * std::sqrt(count - 2.0) : 0.0;
  }
};

using Cosines = std::vector<SharedVector>;  // a replicate each

std::vector<Products> products_of(const Cosines& a, const Cosines& b,
                                  const std::vector<double>& edges) {
  std::vector<Products> out(edges.size() - 1);
  for (std::size_t k = 0; k < a.size(); ++k) {
    for (std::size_t i = 0; i < out.size(); ++i) {
      const Index begin = coefficients_below(edges[i], a[k].size() + 1);
      const Index n = coefficients_below(edges[i + 1], a[k].size() + 1) - begin;
      const auto x = a[k].segment(begin, n);
      const auto y = b[k].segment(begin, n);
      out[i].first += x.squaredNorm();
      out[i].second += y.squaredNorm();
      out[i].both += x.dot(y);
      out[i].count += static_cast<double>(n);
    }
  }
  return out;
}

double two_sided(double sigma) { return std::erfc(std::abs(sigma) / std::sqrt(2.0)); }

SensorPair strongest(const std::vector<Products>& at, const std::vector<double>& edges,
                     Hertz rate) {
  const auto best =
      std::max_element(at.begin(), at.end(), [](const Products& a, const Products& b) {
        return std::abs(a.sigma()) < std::abs(b.sigma());
      });
  auto begin = static_cast<std::size_t>(best - at.begin());
  auto end = begin + 1;
  const auto agrees = [&](const Products& one) {
    return std::abs(one.sigma()) > kAgreeing && (one.both > 0.0) == (best->both > 0.0);
  };
  while (begin > 0 && agrees(at[begin - 1])) --begin;
  while (end < at.size() && agrees(at[end])) ++end;
  SensorPair out;
  out.from = rate.value * edges[begin];
  out.to = rate.value * edges[end];
  out.correlation = best->correlation();
  out.sigma = best->sigma();
  out.p_value = two_sided(out.sigma);
  return out;
}

// Of the channel under study with each witness, or of every two.
std::vector<SensorPair> pairs_of(const Current& current, bool all) {
  const Subject& subject = current.subject();
  std::vector<const Cosines*> channels{&current.cosines};
  for (const Witness& one : subject.witnesses) channels.push_back(&one.cosines);
  std::vector<SensorPair> out;
  for (std::size_t i = 0; i < (all ? channels.size() : 1); ++i) {
    for (std::size_t j = i + 1; j < channels.size(); ++j) out.push_back({.first = i, .second = j});
  }
  const std::vector<double> edges = half_octaves(subject.length(current.longest()));
  if (edges.size() < 2) return {};
  for_each_index(out.size(), [&](std::size_t p) {
    SensorPair found = strongest(
        products_of(*channels[out[p].first], *channels[out[p].second], edges), edges, subject.rate);
    found.first = out[p].first;
    found.second = out[p].second;
    found.places = edges.size() - 1;
    out[p] = found;
  });
  const double looked = static_cast<double>(out.size() * (edges.size() - 1));
  for (SensorPair& one : out) one.p_value = std::min(1.0, looked * one.p_value);
  return out;
}

}  // namespace

std::vector<SensorPair> sensor_pairs(const Current& current) { return pairs_of(current, true); }

std::vector<SensorPair> witness_pairs(const Current& current) { return pairs_of(current, false); }

}  // namespace imunoise
