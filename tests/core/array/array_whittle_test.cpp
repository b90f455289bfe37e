// Whittle's likelihood of an array against what is known of it.

#include "core/array/array_whittle.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

#include "core/array/array_inference.h"
#include "core/estimate/whittle.h"
#include "tests/core/array/simulated_array.h"
#include "tests/support/figures_alone.h"

namespace imunoise {
namespace {

constexpr Hertz kRate{1.0};
constexpr std::size_t kSamples = 4096;

ArrayModel model_of(const char* text, const ArrayLayout& layout) {
  return expand(parse_array_model(text, kRate).value(), layout);
}

// Bands whose cross powers are the model's, as if averaged over endless repetition.
CrossPower theory(const ArrayModel& model) {
  CrossPower out = cross_power(Eigen::MatrixXd::Zero(kSamples, model.sensors), kRate);
  for (std::size_t b = 0; b < out.power.size(); ++b) {
    for (const Latent& latent : model.latents) {
      out.power[b] +=
          spectrum(latent.term.process, out.frequency(static_cast<Eigen::Index>(b))) * latent.power;
    }
  }
  return out;
}

// A model with every kind of term, and values that are not alike.
ArrayModel truth() {
  ArrayModel out = model_of("RW[corr] + AR1[group] + WN", {3, {0, 0, 1}});
  out.latents[0].power << 2e-3, 5e-4, -3e-4,  //
      5e-4, 1e-3, 2e-4,                       //
      -3e-4, 2e-4, 3e-3;
  for (std::size_t t = 1; t < out.latents.size(); ++t)
    out.latents[t].set_scalar(0.3 * static_cast<double>(t));
  set_values(out.latents[1].term.process, std::vector<double>{1.0, 0.95});
  set_values(out.latents[2].term.process, std::vector<double>{1.0, 0.8});
  return out;
}

ArrayFit fit_of(ArrayModel model) {
  ArrayFit out;
  out.parameters = parameters_of(model);
  out.model = std::move(model);
  return out;
}

void expect_truth_from(const ArrayModel& start) {
  const ArrayModel wanted = truth();
  const CrossPower bands = theory(wanted);
  const ArrayFit found = make_efficient(fit_of(start), std::span(&bands, 1));
  EXPECT_EQ(found.termination, Termination::kConverged);
  for (const ArrayParameter& parameter : found.parameters) {
    const double value = value_of(wanted, parameter);
    EXPECT_NEAR(parameter.estimate.value, value, 1e-4 * std::abs(value) + 1e-7)
        << parameter.latent << " " << parameter.parameter;
  }
}

TEST(ArrayWhittle, ComesBackToTheModelThatItsBandsComeFrom) {
  ArrayModel start = truth();
  for (Latent& latent : start.latents) latent.power *= 1.7;
  set_values(start.latents[1].term.process, std::vector<double>{1.0, 0.9});
  expect_truth_from(start);
}

// Moments gave one sensor's process a shape that it does not have, where it has no power: a maximum
// of its own.
TEST(ArrayWhittle, ComesBackWhereOneSensorLostItsProcess) {
  ArrayModel wanted = model_of("AR1[all] + AR1 + WN", {3, {}});
  for (Latent& latent : wanted.latents) {
    const bool common = latent.written == 0;
    latent.set_scalar(common ? 0.05 : latent.written == 1 ? 0.02 : 0.09);
    if (latent.written < 2)
      set_values(latent.term.process, std::vector<double>{1.0, common ? 0.95 : 0.9});
  }
  const CrossPower bands = theory(wanted);
  ArrayModel start = wanted;
  const auto own = std::find_if(start.latents.begin(), start.latents.end(),
                                [](const Latent& latent) { return latent.written == 1; });
  set_values(own->term.process, std::vector<double>{1.0, -0.97});
  own->set_scalar(5e-5);
  const ArrayFit found = make_efficient(fit_of(start), std::span(&bands, 1));
  EXPECT_NEAR(whittle_objective(found.model, std::span(&bands, 1)),
              whittle_objective(wanted, std::span(&bands, 1)), 1e-3);
}

// Moments put a slow process at the end of its scale, or its power at zero.
TEST(ArrayWhittle, ComesBackFromWhereShapesAreNotFelt) {
  const std::vector<double> endless = {1.0, 1.0 - 1e-12};
  ArrayModel start = truth();
  set_values(start.latents[1].term.process, endless);
  set_values(start.latents[2].term.process, endless);
  start.latents[2].set_scalar(0.0);
  expect_truth_from(start);
}

// The information is the curvature of the objective where the bands are the model's own.
TEST(ArrayWhittle, ErrorsAreThoseOfTheCurvature) {
  const ArrayModel model = truth();
  const CrossPower bands = theory(model);
  const ArrayFit fit = make_efficient(fit_of(model), std::span(&bands, 1));
  const auto n = static_cast<Eigen::Index>(fit.parameters.size());
  const auto moved = [&](Eigen::Index i, double by, ArrayModel from) {
    const ArrayParameter& parameter = fit.parameters[static_cast<std::size_t>(i)];
    Latent& latent = from.latents[parameter.latent];
    if (parameter.parameter > 0) {
      std::vector<double> v = values(latent.term.process);
      v[parameter.parameter] += by;
      set_values(latent.term.process, v);
    } else if (latent.matrix()) {
      latent.power(parameter.row, parameter.column) += by;
      if (parameter.row != parameter.column) latent.power(parameter.column, parameter.row) += by;
    } else {
      latent.set_scalar(latent.scalar() + by);
    }
    return from;
  };
  Eigen::MatrixXd curvature(n, n);
  const Eigen::VectorXd step = 0.02 * fit.covariance.diagonal().cwiseSqrt();
  for (Eigen::Index i = 0; i < n; ++i) {
    for (Eigen::Index j = 0; j < n; ++j) {
      const auto at = [&](double a, double b) {
        return whittle_objective(moved(i, a * step(i), moved(j, b * step(j), fit.model)),
                                 std::span(&bands, 1));
      };
      curvature(i, j) = (at(1, 1) - at(1, -1) - at(-1, 1) + at(-1, -1)) / (4 * step(i) * step(j));
    }
  }
  const Eigen::MatrixXd product = curvature * fit.covariance;
  EXPECT_LT((product - Eigen::MatrixXd::Identity(n, n)).cwiseAbs().maxCoeff(), 0.02);
}

TEST(ArrayWhittle, OfOneSensorIsThatOfASignal) {
  const ArrayModel array = model_of("AR1(sigma2=0.2, phi=0.9) + WN(sigma2=1)", {1, {}});
  const Eigen::MatrixXd samples = simulate(array, kSamples, 5, 0);
  const CrossPower cross = testing::powers_of(samples);
  const BandedPower own = banded_power(signals_of(samples, kRate).front());
  const Model model = parse_model("AR1(sigma2=0.2, phi=0.9) + WN(sigma2=1)", kRate).value();
  EXPECT_NEAR(whittle_objective(array, std::span(&cross, 1)),
              whittle_objective(model, std::span(&own, 1)), 1e-6);
}

TEST(ArrayWhittle, KeepsMatricesPositiveSemidefinite) {
  FIGURES_ALONE();
  ArrayModel wanted = model_of("RW[corr] + WN", {2, {}});
  wanted.latents[0].power << 1.0, 1.0, 1.0, 1.0;  // one walk in both
  const CrossPower bands = testing::powers_of(simulate(wanted, kSamples, 6, 0));
  ArrayModel start = wanted;
  start.latents[0].power << 1.0, 0.2, 0.2, 2.0;
  const ArrayFit found = make_efficient(fit_of(start), std::span(&bands, 1));
  const Eigen::MatrixXd& power = found.model.latents[0].power;
  EXPECT_GE(symmetric_eigen(power).values(0), -1e-9 * power.trace());
  EXPECT_NEAR(power(0, 1) / std::sqrt(power(0, 0) * power(1, 1)), 1.0, 0.01);
}

TEST(ArrayWhittle, ARampIsNoNoise) {
  EXPECT_TRUE(has_likelihood(model_of("RW + WN", {2, {}})));
  EXPECT_FALSE(has_likelihood(model_of("DR + WN", {2, {}})));
}

}  // namespace
}  // namespace imunoise
