#include "core/spectrum/roots_of_unity.h"

#include <numbers>

namespace imunoise {

RootsOfUnity::RootsOfUnity(std::size_t n) : coarse_(n / kStretch + 1), fine_(kStretch) {
  const auto root = [&](std::size_t k) {
    return std::polar(1.0,
                      2.0 * std::numbers::pi * static_cast<double>(k) / static_cast<double>(n));
  };
  for (std::size_t k = 0; k < coarse_.size(); ++k) coarse_[k] = root(k * kStretch);
  for (std::size_t k = 0; k < fine_.size(); ++k) fine_[k] = root(k);
}

}  // namespace imunoise
