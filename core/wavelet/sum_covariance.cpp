#include "core/wavelet/sum_covariance.h"

#include <algorithm>

namespace imunoise {

SumCovariance& SumCovariance::operator+=(const SumCovariance& other) {
  linear += other.linear;
  cubic += other.cubic;
  near.resize(std::max(near.size(), other.near.size()), 0.0);
  for (std::size_t i = 0; i < other.near.size(); ++i) near[i] += other.near[i];
  exponentials.insert(exponentials.end(), other.exponentials.begin(), other.exponentials.end());
  flicker += other.flicker;
  slope_squared += other.slope_squared;
  return *this;
}

SumCovariance SumCovariance::scaled(double power) const {
  SumCovariance out = *this;
  out.linear *= power;
  out.cubic *= power;
  for (double& value : out.near) value *= power;
  for (auto& component : out.exponentials) component.amplitude *= power;
  out.flicker *= power;
  out.slope_squared *= power;
  return out;
}

}  // namespace imunoise
