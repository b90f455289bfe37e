#include "core/wavelet/moment_covariance.h"

#include <gtest/gtest.h>

#include <cmath>

#include "core/process/process.h"
#include "core/support/distributions.h"
#include "core/wavelet/discrete_quadrature.h"
#include "core/wavelet/sum_covariance_terms.h"
#include "tests/support/golden.h"

namespace imunoise {
namespace {

// The definition: dense filter matrices, dense covariance of the samples.
Eigen::MatrixXd covariance_by_definition(const std::vector<double>& gamma, const Scales& scales,
                                         std::size_t samples) {
  using Dense = Eigen::MatrixXd;
  const auto n = static_cast<Eigen::Index>(samples);
  Dense cov(n, n);
  for (Eigen::Index a = 0; a < n; ++a) {
    for (Eigen::Index b = 0; b < n; ++b)
      cov(a, b) = gamma[static_cast<std::size_t>(std::abs(a - b))];
  }
  std::vector<Dense> filters;
  for (const std::int64_t m : scales) {
    Dense h = Dense::Zero(n - 2 * m + 1, n);
    for (Eigen::Index t = 0; t < h.rows(); ++t) {
      for (Eigen::Index i = 0; i < m; ++i) {
        h(t, t + i) = -0.5 / static_cast<double>(m);
        h(t, t + m + i) = 0.5 / static_cast<double>(m);
      }
    }
    filters.push_back(h);
  }
  const auto count = static_cast<Eigen::Index>(scales.size());
  Eigen::MatrixXd out(count, count);
  for (Eigen::Index j = 0; j < count; ++j) {
    for (Eigen::Index k = 0; k < count; ++k) {
      const Dense& hj = filters[static_cast<std::size_t>(j)];
      const Dense& hk = filters[static_cast<std::size_t>(k)];
      const Dense cross = hj * cov * hk.transpose();
      out(j, k) = 2.0 * cross.squaredNorm() / static_cast<double>(hj.rows() * hk.rows());
    }
  }
  return out;
}

std::vector<double> exponential(double amplitude, double root, std::size_t n) {
  std::vector<double> out(n);
  for (std::size_t h = 0; h < n; ++h) out[h] = amplitude * std::pow(root, static_cast<double>(h));
  return out;
}

void expect_close(const Eigen::MatrixXd& got, const Eigen::MatrixXd& expected, double tolerance,
                  const std::string& what) {
  for (Eigen::Index j = 0; j < got.rows(); ++j) {
    for (Eigen::Index k = 0; k < got.cols(); ++k) {
      const double scale = std::sqrt(expected(j, j) * expected(k, k));
      EXPECT_NEAR(got(j, k), expected(j, k), tolerance * scale) << what << " " << j << " " << k;
    }
  }
}

TEST(DiscreteRule, IsExactForPolynomials) {
  for (const std::int64_t n : {36, 37, 48, 1000, 100'000}) {
    const DiscreteRule rule = discrete_rule(n);
    const double h = 0.5 * static_cast<double>(n - 1);
    for (const int degree : {0, 1, 2, 7, 16, 22}) {
      long double exact = 0;
      for (std::int64_t s = 0; s < n; ++s) {
        exact += std::pow((static_cast<long double>(s) - h) / h, degree);
      }
      double sum = 0.0;
      for (std::size_t i = 0; i < rule.nodes.size(); ++i) {
        sum += rule.weights[i] * std::pow((rule.nodes[i] - h) / h, degree);
      }
      EXPECT_NEAR(sum, static_cast<double>(exact), 1e-11 * static_cast<double>(n))
          << n << " " << degree;
    }
  }
}

TEST(MomentCovariance, EqualsTheDenseDefinition) {
  const std::size_t samples = 200;
  const Scales scales({1, 2, 3, 8, 20, 64, 100});
  struct Case {
    std::string name;
    Process process;
    std::vector<double> gamma;
  };
  std::vector<double> white(samples, 0.0);
  white[0] = 1.0;
  std::vector<double> quantised(samples, 0.0);
  quantised[0] = 2.0;
  quantised[1] = -1.0;
  const Resonance ringing{1.0, 0.97, 0.4};
  std::vector<double> resonance(samples);
  {
    const SumCovariance sum = sum_covariance(ringing);
    for (std::size_t h = 0; h < samples; ++h) {
      resonance[h] = (sum.exponentials[0].amplitude *
                      std::pow(sum.exponentials[0].root, static_cast<double>(h)))
                         .real();
    }
  }
  const std::vector<Case> cases = {
      {"WN", WhiteNoise{1.0}, white},
      {"QN", QuantisationNoise{1.0}, quantised},
      {"AR1 .9", Ar1{0.19, 0.9}, exponential(1.0, 0.9, samples)},
      {"AR1 .9999", Ar1{1.0 - 0.9999 * 0.9999, 0.9999}, exponential(1.0, 0.9999, samples)},
      {"AR1 -.8", Ar1{0.36, -0.8}, exponential(1.0, -0.8, samples)},
      {"RES", ringing, resonance}};
  for (const Case& c : cases) {
    expect_close(moment_covariance(sum_covariance(c.process), scales, samples),
                 covariance_by_definition(c.gamma, scales, samples), 1e-9, c.name);
  }
}

// The quadrature between kinks, against plain summation over every lag (which small signals get
// anyway).
TEST(MomentCovariance, QuadratureAgreesWithPlainSummation) {
  const std::size_t samples = 40'000;
  const Scales scales({1, 7, 64, 1000, 5000, 20'000});
  SumCovariance process = sum_covariance(WhiteNoise{1.0});
  process += sum_covariance(RandomWalk{1e-5});
  process += sum_covariance(Ar1{1e-3, 0.99});
  process += sum_covariance(Ar1{1e-3, 0.5});
  const Eigen::MatrixXd fast = moment_covariance(process, scales, samples);
  // A table of zeros as long as the signal says that every lag needs summing by itself.
  process.near.assign(samples, 0.0);
  expect_close(fast, moment_covariance(process, scales, samples), 1e-9, "mixture");
}

// Sums of shapes that are kept, against those of this very process.
TEST(MomentCovariance, OfFlickerNoiseIsMadeOfKeptSums) {
  const std::size_t samples = 3000;
  const Scales scales = Scales::for_samples(samples, 2);
  for (const double flicker : {1e-3, 1.0}) {
    SumCovariance process = sum_covariance(WhiteNoise{1.0});
    process += sum_covariance(RandomWalk{1e-5});
    process += sum_covariance(Flicker{flicker});
    process += sum_covariance(RateRamp{1e-4});
    const Eigen::MatrixXd kept = moment_covariance(process, scales, samples);
    process.near = {0.0};  // no longer made of those shapes alone
    expect_close(kept, moment_covariance(process, scales, samples), 1e-9, "kept");
  }
}

TEST(MomentCovariance, Golden) {
  IMUNOISE_NEEDS("golden/reference.json");
  const auto golden = testing::read_json("golden/reference.json");
  SumCovariance mixture = sum_covariance(WhiteNoise{1.0});
  mixture += sum_covariance(RandomWalk{0.02});
  mixture += sum_covariance(QuantisationNoise{0.2});
  mixture += sum_covariance(Ar1{0.3, 0.9});
  const std::vector<std::pair<std::string, SumCovariance>> cases = {
      {"WN", sum_covariance(WhiteNoise{1.0})},
      {"RW", sum_covariance(RandomWalk{1.0})},
      // The file's pure QN entry leaves out the lags ±2m, where QN's γ is not zero (0.07115 for the
      // 0.07321 of the dense definition above); its mixture, with QN inside, does not.
      {"WN1_RW.02_QN.2_AR1(.9,.3)", mixture}};
  for (const auto& [name, process] : cases) {
    const auto& row = golden["V_T120"][name];
    const Scales scales(row["ms"].get<std::vector<std::int64_t>>());
    const auto n = static_cast<Eigen::Index>(scales.size());
    Eigen::MatrixXd expected(n, n);
    for (Eigen::Index j = 0; j < n; ++j) {
      for (Eigen::Index k = 0; k < n; ++k) {
        expected(j, k) =
            row["V"][static_cast<std::size_t>(j)][static_cast<std::size_t>(k)].get<double>();
      }
    }
    expect_close(moment_covariance(process, scales, 120), expected, 1e-9, name);
  }
  const Scales scales = Scales::for_samples(4096);
  for (const auto& [name, process] : std::vector<std::pair<std::string, Process>>{
           {"WN_T4096", WhiteNoise{1.0}}, {"RW_T4096", RandomWalk{1.0}}}) {
    const Eigen::MatrixXd v = moment_covariance(sum_covariance(process), scales, 4096);
    const Eigen::ArrayXd nu = variance(process, scales.half_widths());
    for (std::size_t i = 0; i < scales.size(); ++i) {
      const auto at = static_cast<Eigen::Index>(i);
      EXPECT_NEAR(2.0 * nu(at) * nu(at) / v(at, at) / golden["edof"][name][i].get<double>(), 1.0,
                  1e-8)
          << name << i;
    }
  }
}

// Sums over lags take its expansion from 32 on.
TEST(FlickerCovariance, ItsExpansionIsDigamma) {
  for (const double s : {31.999, 32.0, 32.5, 47.0, 300.25, 1e4, 3.7e6, 1e9}) {
    const double exact = digamma(s + 0.5);
    EXPECT_NEAR(digamma_of_half_beyond(s), exact, 4e-16 * exact) << s;
  }
}

}  // namespace
}  // namespace imunoise
