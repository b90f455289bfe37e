// Intervals of a wavelet cross-covariance without a model: how often they hold the truth and how
// wide they are, beside those of the peers' program and the plain ones with M/2m independent pairs.

#include <gtest/gtest.h>

#include <Eigen/Dense>
#include <cmath>
#include <complex>
#include <cstdio>
#include <numbers>

#include "core/array/array_moments.h"
#include "core/support/distributions.h"
#include "core/support/parallel.h"
#include "core/wavelet/wavelet_variance.h"
#include "tests/core/array/simulated_array.h"
#include "tests/support/golden.h"

namespace imunoise {
namespace {

constexpr std::uint64_t kSeed = 20261121;

// The products W^a W^b of one scale.
Eigen::ArrayXd products(const std::vector<double>& a, const std::vector<double>& b, std::size_t m) {
  std::vector<double> sum_a = {0.0};
  std::vector<double> sum_b = {0.0};
  for (const double x : a) sum_a.push_back(sum_a.back() + x);
  for (const double x : b) sum_b.push_back(sum_b.back() + x);
  const auto w = [m](const std::vector<double>& s, std::size_t t) {
    return (s[t] - 2.0 * s[t - m] + s[t - 2 * m]) / (2.0 * static_cast<double>(m));
  };
  Eigen::ArrayXd out(static_cast<Eigen::Index>(a.size() - 2 * m + 1));
  for (Eigen::Index i = 0; i < out.size(); ++i) {
    const auto t = static_cast<std::size_t>(i) + 2 * m;
    out(i) = w(sum_a, t) * w(sum_b, t);
  }
  return out;
}

// Variance of the mean of a correlated series from its spectrum at frequency zero: means of at most
// 130 batches, the logarithm of their periodogram as a quadratic in frequency, fitted by gamma
// regression (Heidelberger & Welch 1981), which is what the peers use.
double spectral_variance(const Eigen::ArrayXd& x) {
  constexpr Eigen::Index kBatches = 130;
  const Eigen::Index width = (x.size() + kBatches - 1) / kBatches;
  const Eigen::Index n = x.size() / width;
  Eigen::ArrayXd means(n);
  for (Eigen::Index i = 0; i < n; ++i) means(i) = x.segment(i * width, width).mean();
  const Eigen::Index frequencies = n / 2;
  if (frequencies < 4) return std::nan("");
  Eigen::VectorXd power(frequencies);
  Eigen::MatrixXd design(frequencies, 3);
  for (Eigen::Index k = 0; k < frequencies; ++k) {
    const double f = static_cast<double>(k + 1) / static_cast<double>(n);
    std::complex<double> sum = 0.0;
    for (Eigen::Index t = 0; t < n; ++t) {
      sum += means(t) * std::polar(1.0, -2.0 * std::numbers::pi * f * static_cast<double>(t));
    }
    power(k) = std::norm(sum) / static_cast<double>(n);
    design.row(k) << 1.0, f, f * f;
  }
  Eigen::Vector3d beta(std::log(power.mean()), 0.0, 0.0);
  const auto solver = design.colPivHouseholderQr();
  for (int i = 0; i < 50; ++i) {
    const Eigen::VectorXd eta = design * beta;
    beta = solver.solve((eta.array() + power.array() * (-eta.array()).exp() - 1.0).matrix());
  }
  return std::exp(beta(0)) * static_cast<double>(width) / static_cast<double>(x.size());
}

TEST(CrossCovarianceIntervals, PeersVarianceIsTheSpectrumOfTheProductsAtZero) {
  IMUNOISE_NEEDS("golden/wccv_virtual.json");
  const auto golden = testing::read_json("golden/wccv_virtual.json")["sim"];
  const std::vector<double> rows = testing::read_doubles("golden/array6_65536.f64");
  std::vector<std::vector<double>> columns(6);
  for (std::size_t i = 0; i < rows.size(); ++i) columns[i % 6].push_back(rows[i]);
  for (const auto& pair : golden["wccv_pairs_wvpkg"]) {
    if (!pair.contains("var") || pair["var"].empty()) continue;
    const auto a = pair["i"].get<std::size_t>() - 1;
    const auto b = pair["j"].get<std::size_t>() - 1;
    std::printf("%zu %zu:", a, b);
    for (std::size_t j = 0; j < pair["var"].size(); ++j) {
      const Eigen::ArrayXd z = products(columns[a], columns[b], std::size_t{1} << j);
      std::printf(" %.3f", spectral_variance(z) / pair["var"][j].get<double>());
    }
    std::printf("\n");
  }
}

}  // namespace
}  // namespace imunoise
