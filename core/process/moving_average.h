#pragma once

#include <cmath>
#include <complex>

#include "core/process/finite_memory.h"

namespace imunoise {

/// MA(q): x_t = e_t + θ_1 e_{t-1} + .. + θ_q e_{t-q}, var e = σ². For q > 1 the search covers all θ
/// whose polynomial may be invertible; another θ with the same autocovariance may exist outside.
struct MovingAverage {
  double sigma2 = 1.0;
  std::vector<double> theta = {0.0};

  static constexpr ProcessInfo kInfo{
      "MA", "moving-average noise",
      "White noise seen through a short digital filter of unknown taps.", "number of coefficients"};
  static constexpr int kLargest = 6;
  friend bool operator==(const MovingAverage&, const MovingAverage&) = default;

  static MovingAverage with_structure(int q) {
    return {1.0, std::vector<double>(static_cast<std::size_t>(q), 0.0)};
  }
  int structure() const { return static_cast<int>(theta.size()); }

  std::vector<ParameterInfo> parameters() const {
    std::vector<ParameterInfo> out = {{"sigma2", "variance of the input"}};
    double bound = 1.0;  // of an invertible polynomial: binomial(q, k)
    for (std::size_t k = 1; k <= theta.size(); ++k) {
      bound *= static_cast<double>(theta.size() - k + 1) / static_cast<double>(k);
      out.push_back(
          {"theta" + std::to_string(k), "coefficient", Dimension::kPurePerSample, -bound, bound});
    }
    return out;
  }
  std::vector<double> values() const {
    std::vector<double> out = {sigma2};
    out.insert(out.end(), theta.begin(), theta.end());
    return out;
  }
  void set_values(std::span<const double> v) {
    sigma2 = v[0];
    theta.assign(v.begin() + 1, v.end());
  }
  FiniteMemory filter() const {
    std::vector<double> taps = {1.0};
    taps.insert(taps.end(), theta.begin(), theta.end());
    return FiniteMemory(std::move(taps));
  }
  Eigen::ArrayXd shape(HalfWidths m) const { return filter().variance(m); }
  Eigen::ArrayXXd shape_jacobian(HalfWidths m) const {
    Eigen::ArrayXXd out(m.size(), static_cast<Eigen::Index>(theta.size()));
    for (std::size_t k = 0; k < theta.size(); ++k) {
      out.col(static_cast<Eigen::Index>(k)) = filter().slope(m, k + 1);
    }
    return out;
  }
  double spectrum(const Frequency& f) const {
    const std::complex<double> turn = f.turn();
    std::complex<double> response = 0.0;
    for (std::size_t k = theta.size(); k-- > 0;) response = (response + theta[k]) * turn;
    return sigma2 * std::norm(1.0 + response);
  }
  SumCovariance sum_covariance() const { return filter().sum_covariance().scaled(sigma2); }
  std::vector<DerivedQuantity> derived(Hertz rate) const {
    double gain = 1.0;
    for (const double t : theta) gain += t;
    return {{Coefficient::kRandomWalk, std::abs(gain) * std::sqrt(sigma2 / rate.value)}};
  }
  std::vector<std::vector<double>> scan(const Scales&) const {
    std::vector<std::vector<double>> out = {{}};
    for (std::size_t k = 0; k < theta.size(); ++k) {
      std::vector<std::vector<double>> longer;
      for (const auto& start : out) {
        for (const double t : {-0.6, -0.2, 0.2, 0.6}) {
          longer.push_back(start);
          longer.back().push_back(t);
        }
      }
      out = std::move(longer);
    }
    return out;
  }
  FiniteMemory::Recursion recursion(RandomStream& rng) const {
    return filter().recursion(std::sqrt(sigma2), rng);
  }
};

}  // namespace imunoise
