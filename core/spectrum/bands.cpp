#include "core/spectrum/bands.h"

#include <algorithm>

namespace imunoise {
namespace {

constexpr Eigen::Index kBandsPerFrequency = 256;

}  // namespace

Bands::Bands(Eigen::Index n) : edges{0} {
  while (edges.back() < n - 1) {
    const Eigen::Index width = 1 + edges.back() / kBandsPerFrequency;
    edges.push_back(std::min(n - 1, edges.back() + width));
  }
  const auto bands = static_cast<Eigen::Index>(edges.size()) - 1;
  frequency.resize(bands);
  count.resize(bands);
  for (Eigen::Index b = 0; b < bands; ++b) {
    const auto begin = static_cast<double>(edges[static_cast<std::size_t>(b)]);
    count(b) = static_cast<double>(edges[static_cast<std::size_t>(b) + 1]) - begin;
    frequency(b) = (begin + 0.5 * (count(b) + 1.0)) / (2.0 * static_cast<double>(n));
  }
}

}  // namespace imunoise
