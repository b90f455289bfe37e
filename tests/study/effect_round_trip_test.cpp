// One grammar: what `simulate` puts into samples `fit` finds within its errors, a study agrees, and
// what it prints can be fitted, simulated and tested. Over every effect that there is.

#include <fmt/format.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <memory>

#include "core/effects/known_effects.h"
#include "core/effects/parse_full_model.h"
#include "core/effects/simulation.h"
#include "study/analysis/evaluate.h"
#include "study/analysis/fit_series.h"
#include "study/analysis/less_effects.h"
#include "study/analysis/select_model.h"
#include "study/analysis/test_series.h"

namespace imunoise::study {
namespace {

constexpr Hertz kTripRate{10.0};
constexpr std::size_t kTripSamples = 10'000;
constexpr std::uint32_t kTripReplicates = 3;
constexpr std::uint64_t kTripSeed = 20'261;

// An effect with its sizes. A fit may differ by so much of a size of which it tells no interval:
// four and a half standard errors of what is counted (jumps, outliers, replicates).
struct Example {
  const char* written;
  double counted = 0.0;
  double white = 1.0;  // variance of the white noise that a fit then finds
};

// `heat` is the witness. Each size is many standard errors of a fit to white noise of variance 1.
const std::vector<Example>& examples() {
  static const std::vector<Example> all{
      {"ramp(slope=1e-3)"},
      {"ramp(own, slope=1e-3)", 1.9},  // of three replicates: 4.5/√6
      {"warm_up(tau=100, amplitude=1)"},
      {"common_course(terms=5, amplitude=0.3)"},
      {"line(f=0.7, amplitude=0.3)"},
      {"line(f=0.7, harmonics=2, amplitude=0.3, phase=1)"},
      {"step(replicate=2, t=400, height=0.5)"},
      {"witness(heat, coefficient=0.1)"},
      {"witness(heat, lag=20, coefficient=0.1)"},
      {"witness(heat, to=0.5, coefficient=0.1)"},
      {"witness(heat, noise=0.01, coefficient=0.1)"},
      // The noise of a fit has the mean power; what is written holds where the first replicate is.
      {"modulated(heat, log_variance_slope=0.05)", 0.0, 1.28},
      {"telegraph(height=3, dwell=30)", 0.5},            // of some 100 jumps
      {"outliers(above=6, share=0.004, size=15)", 0.5},  // of some 120
      {"own_powers(spread=0.5)", 1.9},
      {"heavy_tails(dof=4, size=2)", 0.2, 5.0},  // the tails are those of all noise
      {"variance_wander(tau=20, deviation=0.8)", 0.5},
      {"bursts(length=20, every=200, ratio=6)", 0.3},
      {"power_change(replicate=2, from=100, to=400, ratio=3)"},
      {"wander(from=0.6, to=0.8, amplitude=0.8)", 0.3},
      {"oscillation(from=0.5, to=0.9, amplitude=1.5)", 0.2},
      {"two_lags(heat, fast=3, slow=20, coefficient=0.1)"},
  };
  return all;
}

Simulation simulation_of(const std::string& model) {
  const Model heat = *parse_model("RW(gamma2=0.01)", kTripRate);
  return Simulation::make(
             *parse_full_model(model, kTripRate), {kTripSamples, kTripRate, kTripReplicates},
             kTripSeed,
             {{"heat",
               [heat](std::uint32_t k) { return simulate(heat, kTripSamples, kTripSeed + 1, k); }}})
      .value();
}

recording::Channel channel_of(const std::string& name, std::vector<double> samples, Unit unit) {
  return {name,       std::make_shared<recording::Samples>(std::move(samples)),
          0,          kTripSamples,
          unit.to_si, 0.0,
          unit,       kTripRate};
}

std::vector<recording::Replicate> recorded(const std::string& model) {
  const Simulation simulation = simulation_of(model);
  std::vector<recording::Replicate> out;
  for (std::uint32_t k = 0; k < kTripReplicates; ++k) {
    SimulatedSamples drawn = simulation.replicate(k);
    out.push_back({fmt::format("run{}", k + 1),
                   "",
                   kTripRate,
                   {channel_of("gyro", std::move(drawn.channel), *parse_unit("rad/s")),
                    channel_of("heat", std::move(drawn.witnesses[0]), *parse_unit("K"))}});
  }
  return out;
}

EffectTerm effect_in(const std::string& model) {
  return parse_full_model(model, kTripRate).value().effects.front();
}

// Of numbers that say an interval: its half-width as standard errors.
double error_of(const v1::EffectParameter& one) {
  return one.has_lower() ? (one.upper() - one.lower()) / (2.0 * 1.959964) : 0.0;
}

// Compares each size that was put in with what a fit found of it; says how many there were.
int compare_sizes(const EffectTerm& truth, const EffectTerm& fitted,
                  const v1::FittedEffect& numbers, double counted) {
  int compared = 0;
  for (std::size_t p = 0; p < truth.values.size(); ++p) {
    const EffectParameter& about = truth.effect->parameters[p];
    if (!about.truth || !truth.given(p) || !fitted.given(p)) continue;
    double error = counted * std::abs(truth[p]);
    for (const v1::EffectParameter& one : numbers.parameters()) {
      if (one.name().starts_with(about.reported)) error = std::max(error, 4.5 * error_of(one));
    }
    EXPECT_NEAR(fitted[p], truth[p], error) << about.name;
    if (counted == 0.0) {
      EXPECT_LT(error, std::abs(truth[p])) << about.name << " is not known at all";
    }
    ++compared;
  }
  return compared;
}

class EffectRoundTrip : public ::testing::TestWithParam<Example> {};

TEST_P(EffectRoundTrip, WhatIsSimulatedIsFittedAndAStudyAgrees) {
  const std::string text = std::string("WN(sigma2=1) + ") + GetParam().written;
  const EffectTerm truth = effect_in(text);
  const std::string model = "WN + " + print(shape_of(truth));
  const std::vector<recording::Replicate> replicates = recorded(text);
  const Series series = series_of(replicates, 0);

  FitOptions options;
  options.model = model;
  const auto fit = fit_series(series, options);
  ASSERT_TRUE(fit) << fit.error().message;
  EXPECT_EQ(fit->model(), model);
  ASSERT_EQ(fit->effects_size(), 1);
  EXPECT_EQ(fit->effects(0).term(), print(shape_of(truth)));
  EXPECT_GE(
      compare_sizes(truth, effect_in(fit->fitted_model()), fit->effects(0), GetParam().counted), 1)
      << fit->fitted_model();
  const v1::Parameter& white = fit->terms(0).parameters(0);
  const double slack = truth.effect->own_noise != nullptr ? 1.0 : 0.1;
  EXPECT_NEAR(white.value(), GetParam().white, slack * GetParam().white) << "the noise beside it";

  const auto look = prepare_channel(replicates, 0, std::nullopt);
  ASSERT_TRUE(look) << look.error().message;
  const auto rung = evaluate(model, look->prepared, {.added = "", .why = ""});
  ASSERT_TRUE(rung) << rung.error().message;
  EXPECT_EQ(rung->model(), model);
  ASSERT_EQ(rung->effects_size(), 1);
  ASSERT_EQ(rung->effects(0).parameters_size(), fit->effects(0).parameters_size());
  for (int i = 0; i < rung->effects(0).parameters_size(); ++i) {
    const double found = fit->effects(0).parameters(i).value();
    EXPECT_NEAR(rung->effects(0).parameters(i).value(), found, 1e-6 * std::abs(found))
        << rung->effects(0).parameters(i).name();
  }

  // What the study prints.
  EXPECT_EQ(simulation_of(rung->fitted_model()).replicate(0).channel.size(), kTripSamples);
  options.model = rung->fitted_model();
  const auto again = fit_series(series, options);
  ASSERT_TRUE(again) << again.error().message;
  TestOptions test;
  test.model = rung->model();
  const auto tested = test_series(series, test);
  const Effect& effect = *truth.effect;
  if (changes_noise(effect)) {
    ASSERT_FALSE(tested);
    EXPECT_NE(tested.error().message.find(std::string(effect.name) + " changes the noise itself"),
              std::string::npos)
        << tested.error().message;
  } else {
    ASSERT_TRUE(tested) << tested.error().message;
    EXPECT_EQ(tested->model(), model);
    EXPECT_FALSE(tested->misfit().rejected() && tested->misfit().p_value() < 1e-6);
  }
}

INSTANTIATE_TEST_SUITE_P(Examples, EffectRoundTrip, ::testing::ValuesIn(examples()),
                         [](const auto& each) {
                           std::string name = each.param.written;
                           name.erase(
                               std::remove_if(name.begin(), name.end(),
                                              [](unsigned char c) { return std::isalnum(c) == 0; }),
                               name.end());
                           return name;
                         });

TEST(EffectExamples, EveryEffectHasOne) {
  for (const Effect* effect : known_effects()) {
    const bool has = std::any_of(examples().begin(), examples().end(), [&](const Example& one) {
      return effect_in(std::string("WN + ") + one.written).effect == effect;
    });
    EXPECT_TRUE(has) << effect->name;
  }
}

TEST(Effects, AChoiceIsBetweenNoiseBesideTheSameEffects) {
  const std::vector<recording::Replicate> replicates =
      recorded("WN(sigma2=1) + RW(gamma2=1e-3) + line(f=0.7, amplitude=2)");
  const Series series = series_of(replicates, 0);
  SelectOptions options;
  options.models = {"WN + RW + line(f=0.7)"};
  const auto chosen = select_model(series, options);
  ASSERT_TRUE(chosen) << chosen.error().message;
  EXPECT_EQ(model_to_use(*chosen).model(), "WN + RW + line(f=0.7)");
  EXPECT_EQ(chosen->candidates_size(), 3);
  EXPECT_FALSE(chosen->far_from_floor());
  EXPECT_EQ(chosen->effects_size(), 1);
  options.models = {"WN + RW + line(f=0.7)", "WN + RW"};
  EXPECT_NE(select_model(series, options).error().message.find("different effects"),
            std::string::npos);
}

TEST(Effects, AWitnessThatWasNotRecordedIsNamed) {
  const std::vector<recording::Replicate> replicates = recorded("WN(sigma2=1)");
  FitOptions options;
  options.model = "WN + witness(cold)";
  const auto fit = fit_series(series_of(replicates, 0), options);
  ASSERT_FALSE(fit);
  EXPECT_NE(fit.error().message.find("'cold'"), std::string::npos) << fit.error().message;
  EXPECT_NE(fit.error().message.find("heat"), std::string::npos) << fit.error().message;
}

}  // namespace
}  // namespace imunoise::study
