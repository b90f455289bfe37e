#include "core/array/mixed_regression.h"

#include <algorithm>
#include <cmath>
#include <numbers>

#include "core/array/array_whittle.h"
#include "core/array/huber_regression.h"
#include "core/array/simulate_array.h"
#include "core/support/distributions.h"
#include "core/support/parallel.h"
#include "core/wavelet/wavelet_covariance.h"

namespace imunoise {
namespace {

constexpr int kRounds = 2;

CoefficientEstimate estimate(double value, double error, double confidence) {
  const double reach = normal_quantile(0.5 + 0.5 * confidence) * error;
  const double p = error > 0.0 ? std::erfc(std::abs(value) / error / std::numbers::sqrt2) : 1.0;
  return {value, error, value - reach, value + reach, p};
}

std::vector<CoefficientEstimate> estimates(const Coefficients& from, double confidence) {
  std::vector<CoefficientEstimate> out;
  for (Eigen::Index j = 0; j < from.value.size(); ++j)
    out.push_back(estimate(from.value(j), std::sqrt(from.covariance(j, j)), confidence));
  return out;
}

// What one set without any effect gives: t of GLS, and Huber's coefficients.
struct Draw {
  Eigen::VectorXd t;
  Eigen::VectorXd robust;
};

Draw draw_null(const ArrayModel& noise, const RegressionData& data, std::uint64_t seed,
               std::uint32_t index) {
  RegressionData null = data;
  null.response = simulate(noise, static_cast<std::size_t>(data.response.rows()), seed, index);
  const BandedRegression regression(null);
  const CrossPower left = regression.residual(regression.under(noise).value);
  const Coefficients found = regression.under(one_step(noise, std::span(&left, 1)));
  return {found.value.cwiseQuotient(found.covariance.diagonal().cwiseSqrt()),
          huber_regression(null)};
}

// p = (1 + #{|null| ≥ |found|}) / (1 + B)
double bootstrap_p(const std::vector<Draw>& draws, Eigen::VectorXd Draw::*what, Eigen::Index j,
                   double found) {
  const auto beyond = std::count_if(draws.begin(), draws.end(), [&](const Draw& draw) {
    return std::abs((draw.*what)(j)) >= std::abs(found);
  });
  return (1.0 + static_cast<double>(beyond)) / (1.0 + static_cast<double>(draws.size()));
}

void add_bootstrap(const RegressionData& data, const RegressionOptions& options,
                   const Progress& progress, MixedRegression& out) {
  std::vector<Draw> draws(options.bootstraps);
  for_each_index(draws.size(), [&](std::size_t i) {
    if (!progress.stopped())
      draws[i] = draw_null(out.noise.model, data, options.seed, static_cast<std::uint32_t>(i));
  });
  if (progress.stopped()) return;
  const Eigen::VectorXd robust = huber_regression(data);
  for (std::size_t c = 0; c < out.gls.size(); ++c) {
    const auto j = static_cast<Eigen::Index>(c);
    CoefficientEstimate& gls = out.gls[c];
    gls.p_value = bootstrap_p(draws, &Draw::t, j, gls.value / gls.standard_error);
    double squares = 0.0;
    for (const Draw& draw : draws) squares += draw.robust(j) * draw.robust(j);
    const double error = std::sqrt(squares / static_cast<double>(draws.size()));
    out.robust.push_back(estimate(robust(j), error, options.confidence));
    out.robust.back().p_value = bootstrap_p(draws, &Draw::robust, j, robust(j));
  }
}

// Variance about its mean that n samples of each series are expected to show: Σ of the powers of
// the cosine transform over n.
Eigen::MatrixXd explained_by(const MixedRegression& fit, std::size_t terms,
                             const RegressionData& data, const CrossPower& bands) {
  const auto n = static_cast<double>(bands.samples);
  Eigen::MatrixXd out = Eigen::MatrixXd::Zero(data.series(), 1 + static_cast<Eigen::Index>(terms));
  Eigen::MatrixXd effect = Eigen::MatrixXd::Zero(data.response.rows(), data.series());
  for (std::size_t j = 0; j < data.regressors.size(); ++j)
    effect += fit.gls[j].value * data.regressors[j];
  out.col(0) = (effect.rowwise() - effect.colwise().mean()).colwise().squaredNorm().transpose() / n;
  for (const Latent& latent : fit.noise.model.latents) {
    const double size = (bands.count * spectrum(latent.term.process, bands.frequency)).sum() / n;
    out.col(1 + static_cast<Eigen::Index>(latent.written)) += size * latent.power.diagonal();
  }
  return out.array().colwise() / out.rowwise().sum().array();
}

}  // namespace

MixedRegression mixed_regression(const Model& written, const ArrayLayout& layout,
                                 const RegressionData& data, const RegressionOptions& options,
                                 const Progress& progress) {
  const BandedRegression regression(data);
  const Coefficients naive = regression.naive();
  MixedRegression out;
  Coefficients found = naive;
  CrossPower left;
  for (int round = 0; round < kRounds; ++round) {
    const Progress part = progress.part(0.15 * round, 0.15 * (round + 1));
    const Eigen::MatrixXd residual = data.residual(found.value);
    const WaveletCovariance moments =
        wavelet_covariance(signals_of(residual, data.rate),
                           Scales::for_samples(static_cast<std::size_t>(residual.rows())));
    left = regression.residual(found.value);
    out.noise = make_efficient(fit_array(written, layout, std::span(&moments, 1),
                                         {.confidence = options.confidence}, part),
                               std::span(&left, 1), options.confidence, part);
    found = regression.under(out.noise.model);
    if (progress.stopped()) return out;
  }
  out.naive = estimates(naive, options.confidence);
  out.gls = estimates(found, options.confidence);
  out.constants = data.residual(found.value).colwise().mean().transpose();
  out.explained = explained_by(out, written.terms.size(), data, left);
  if (options.bootstraps > 0) add_bootstrap(data, options, progress.part(0.3, 1.0), out);
  return out;
}

}  // namespace imunoise
