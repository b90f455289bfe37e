#pragma once

#include <Eigen/Core>
#include <cstddef>
#include <vector>

#include "core/process/process.h"

namespace imunoise {

/// The spectrum of a process next to where its parameters are: to first or second order in some of
/// them, on the scale on which likelihoods are searched. Differences of spectra, good to about
/// 1e-8.
struct SpectralExpansion {
  enum class Order { kFirst, kSecond };

  /// Of `parameters` of a process, each named once, at B frequencies.
  SpectralExpansion(const Process& process, const std::vector<std::size_t>& parameters,
                    const Frequencies& frequency, Order order);

  /// d² spectrum / d parameter i d parameter j, B. Precondition: of second order.
  const Eigen::ArrayXd& bend(std::size_t i, std::size_t j) const {
    return bends[i < j ? j * (j + 1) / 2 + i : i * (i + 1) / 2 + j];
  }

  std::vector<Eigen::ArrayXd> slopes;  ///< d spectrum / d parameter, B each
  std::vector<Eigen::ArrayXd> bends;   ///< see bend()
};

}  // namespace imunoise
