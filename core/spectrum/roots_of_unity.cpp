#include "core/spectrum/roots_of_unity.h"

#include <bit>
#include <numbers>

namespace imunoise {

RootsOfUnity::RootsOfUnity(std::size_t n)
    : bits_(static_cast<unsigned>(std::bit_width(n)) / 2),
      coarse_((n >> bits_) + 1),
      fine_(std::size_t{1} << bits_) {
  const auto root = [&](std::size_t k) {
    return std::polar(1.0,
                      2.0 * std::numbers::pi * static_cast<double>(k) / static_cast<double>(n));
  };
  for (std::size_t k = 0; k < coarse_.size(); ++k) coarse_[k] = root(k << bits_);
  for (std::size_t k = 0; k < fine_.size(); ++k) fine_[k] = root(k);
}

}  // namespace imunoise
