// What holds of every effect that is registered; a new one is tested by being there.

#include <fmt/format.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <fstream>
#include <set>
#include <sstream>

#include "core/diagnosis/candidates.h"
#include "core/diagnosis/causes.h"
#include "core/effect/columns.h"
#include "core/effects/known_effects.h"
#include "core/effects/simulate_effects.h"
#include "core/search/search_view.h"
#include "core/spectrum/cosine_transform.h"
#include "tests/core/diagnosis/subject_of.h"

namespace imunoise {
namespace {

using Index = Eigen::Index;

constexpr double kRate = 50.0;

// Within the bounds of a parameter, and different for each.
double some_value(const EffectParameter& about, std::size_t place) {
  if (about.form == ParameterForm::kFlag) return 1.0;
  if (about.form == ParameterForm::kWholeNumber) return about.lower + 1.0;
  const double value = 3.5 * std::pow(3.0, static_cast<double>(place));
  return about.upper < value ? 0.5 * about.upper : value;
}

EffectTerm with_everything(const Effect& effect) {
  EffectTerm out(effect, effect.witness ? "temperature" : "");
  for (std::size_t i = 0; i < out.values.size(); ++i)
    out.values[i] = some_value(effect.parameters[i], i);
  return out;
}

std::shared_ptr<const Subject> warm_subject(std::uint64_t seed, std::size_t samples = 8192) {
  return subject_of({.samples = samples, .seed = seed, .temperature = [](std::size_t k, double s) {
                       return 2.0 * wave(0.013 + 0.002 * static_cast<double>(k), s) +
                              wave(0.05, s + 3.0);
                     }});
}

class EveryEffect : public testing::TestWithParam<const Effect*> {};

TEST_P(EveryEffect, IsReadAsItIsPrinted) {
  const Effect& effect = *GetParam();
  const EffectTerm term = with_everything(effect);
  const auto read = parse_full_model("WN + " + print(term), Hertz{kRate});
  ASSERT_TRUE(read) << read.error().message;
  ASSERT_EQ(read->effects.size(), 1U);
  EXPECT_EQ(read->effects[0], term) << print(term);
  EXPECT_EQ(print(*read), "WN + " + print(term));
}

TEST_P(EveryEffect, SaysAllOfItself) {
  const Effect& effect = *GetParam();
  EXPECT_FALSE(effect.title.empty());
  EXPECT_TRUE(effect.meaning.ends_with(".")) << effect.meaning;
  EXPECT_NE(effect.search, nullptr);
  EXPECT_NE(effect.simulate, nullptr);
  std::set<std::string_view> names;
  for (const EffectParameter& one : effect.parameters) {
    EXPECT_TRUE(names.insert(one.name).second) << one.name << " twice";
    EXPECT_FALSE(one.meaning.empty()) << one.name;
    const bool size = one.truth || one.form != ParameterForm::kNumber;
    EXPECT_TRUE(size || !one.unit.empty()) << one.name << " has no unit";
  }
  EXPECT_TRUE(std::any_of(effect.parameters.begin(), effect.parameters.end(),
                          [](const EffectParameter& one) { return one.truth; }));
  // It adds to the mean, or changes the noise, or the samples.
  EXPECT_TRUE(effect.regressors != nullptr || effect.variance_course != nullptr ||
              effect.own_noise != nullptr || effect.cleaned != nullptr);
}

TEST_P(EveryEffect, HasCausesThatSayWhatToRecord) {
  for (const Cause& one : GetParam()->causes) {
    EXPECT_FALSE(one.title.empty()) << one.id;
    EXPECT_TRUE(one.physics.ends_with(".")) << one.id;
    EXPECT_FALSE(one.record_next.empty()) << one.id;
    EXPECT_FALSE(one.family.empty()) << one.id;
    for (const std::string_view other : one.looks_like) EXPECT_EQ(cause_info(other).id, other);
  }
}

TEST_P(EveryEffect, IsInTheGuide) {
  std::ifstream file(IMUNOISE_SOURCE_DIR "/docs/diagnosis.md");
  std::stringstream text;
  text << file.rdbuf();
  const std::string name(GetParam()->name);
  EXPECT_TRUE(text.str().find("| `" + name + "`") != std::string::npos ||
              text.str().find("| `" + name + "(") != std::string::npos)
      << "docs/diagnosis.md has no row for " << name;
}

// The shape with required parameters alone, at places that the subject has.
EffectTerm plain_term(const Effect& effect) {
  EffectTerm out(effect, effect.witness ? "temperature" : "");
  for (std::size_t i = 0; i < out.values.size(); ++i) {
    if (effect.parameters[i].required) out.values[i] = some_value(effect.parameters[i], i);
  }
  return out;
}

TEST_P(EveryEffect, HasColumnsWithNamesThatAreTransformsOfWhatItAdds) {
  const auto subject = warm_subject(31, 1000);
  const EffectTerm term = plain_term(*GetParam());
  const Regressors made = regressors_of(term, *subject);
  ASSERT_EQ(made.replicates.size(), subject->replicates());
  for (std::size_t k = 0; k < made.replicates.size(); ++k) {
    const Columns& columns = made.replicates[k];
    ASSERT_EQ(columns.places.size(), columns.cosines.size());
    for (std::size_t i = 0; i < columns.places.size(); ++i) {
      ASSERT_LT(columns.places[i], static_cast<Index>(made.coefficients.size()));
      ASSERT_EQ(columns.cosines[i].size(), subject->length(k) - 1);
      Eigen::VectorXd samples = Eigen::VectorXd::Zero(subject->length(k));
      add_effect(
          term, *subject, k, columns,
          Eigen::VectorXd::Unit(static_cast<Index>(columns.places.size()), static_cast<Index>(i)),
          samples);
      EXPECT_LT((cosine_transform(samples) - columns.cosines[i]).norm(),
                1e-9 * columns.cosines[i].norm())
          << print(term);
    }
  }
  EXPECT_TRUE(unit_of(term, *subject).size() > 0);
}

INSTANTIATE_TEST_SUITE_P(Registered, EveryEffect,
                         testing::ValuesIn(known_effects().begin(), known_effects().end()),
                         [](const auto& one) { return std::string(one.param->name); });

// One line an effect whose size is given, well above the noise of subject_of().
const std::vector<std::string>& simulated_terms() {
  static const std::vector<std::string> kTerms{
      "ramp(slope=0.01)",
      "warm_up(tau=20, amplitude=3)",
      "common_course(terms=6, amplitude=1)",
      "line(f=7.3, amplitude=0.3)",
      "wander(from=7.1, to=7.4, amplitude=0.4)",
      "oscillation(from=6, to=10, amplitude=0.8)",
      "step(replicate=2, t=90, height=0.8)",
      "witness(temperature, coefficient=0.4)",
      "two_lags(temperature, fast=3, slow=6, coefficient=1.5)",
      "modulated(temperature, log_variance_slope=0.3)",
      "telegraph(height=1.5, dwell=25)",
      "outliers(above=6, share=5e-4, size=12)",
      "heavy_tails(dof=4, size=2)",
      "variance_wander(tau=8, deviation=0.6)",
      "bursts(length=2, every=20, ratio=6)",
      "power_change(replicate=2, from=60, to=110, ratio=3)",
      "own_powers(spread=0.4)",
  };
  return kTerms;
}

TEST(Effects, EachHasATermToSimulate) {
  for (const Effect* effect : known_effects()) {
    EXPECT_TRUE(std::any_of(
        simulated_terms().begin(), simulated_terms().end(),
        [&](const std::string& one) { return one.starts_with(std::string(effect->name) + "("); }))
        << "give simulated_terms() one of " << effect->name;
  }
}

TEST(Effects, NamesAreUnique) {
  std::set<std::string_view> names;
  std::set<std::string_view> causes;
  for (const Effect* effect : known_effects())
    EXPECT_TRUE(names.insert(effect->name).second) << effect->name;
  for (const Cause& one : known_causes()) EXPECT_TRUE(causes.insert(one.id).second) << one.id;
}

class SimulatedEffect : public testing::TestWithParam<std::string> {};

// Simulated, then sought: the same effect comes first, and what a fit finds of it holds the truth.
TEST_P(SimulatedEffect, IsFoundAgain) {
  constexpr std::uint64_t kSeed = 32;
  const auto model = parse_full_model("WN + " + GetParam(), Hertz{kRate});
  ASSERT_TRUE(model) << model.error().message;
  const EffectTerm truth = model->effects[0];
  const Result<void> possible = check_simulation(model->effects, *warm_subject(kSeed));
  ASSERT_TRUE(possible) << possible.error().message;
  const FittedModel plain = fitted(with_effects(*warm_subject(kSeed), model->effects, kSeed));
  const Current current = current_of(plain.regression, plain.fit);
  std::vector<TriedTerm> tried = try_all(current, truth.effect->search(SearchView(current)));
  ASSERT_FALSE(tried.empty());
  const TriedTerm& best = tried.front();
  EXPECT_EQ(best.term()->effect, truth.effect);
  EXPECT_GT(best.gain, 20.0) << print(*best.term());
  const std::size_t last = best.fitted.regression.effects().size() - 1;
  for (const ReportedNumber& number : fitted_numbers({best.fitted, last, best.noise_dof})) {
    for (std::size_t i = 0; i < truth.values.size(); ++i) {
      if (number.name != truth.effect->parameters[i].reported || !number.lower) continue;
      // 1.96 standard errors make an interval; 3.9 are passed once in ten thousand.
      const double error = 0.5 * (*number.upper - *number.lower) / 1.96;
      EXPECT_LT(std::abs(number.value - truth[i]), 3.9 * error) << number.name;
    }
  }
}

INSTANTIATE_TEST_SUITE_P(Registered, SimulatedEffect, testing::ValuesIn(simulated_terms()),
                         [](const auto& one) { return one.param.substr(0, one.param.find('(')); });

TEST(Effects, ASimulationSaysWhatItLacks) {
  const auto message = [](const char* text) {
    const auto model = parse_full_model(text, Hertz{kRate});
    const auto subject = subject_of({.samples = 1000});
    const Result<void> possible = check_simulation(model->effects, *subject);
    return possible ? "possible" : possible.error().message;
  };
  EXPECT_EQ(message("WN + line(f=5)"),
            "line(f=5): a simulation needs amplitude=… (amplitude of the fundamental; the multiple "
            "h has an h-th of it)");
  EXPECT_EQ(message("WN + witness(heat, coefficient=1)"),
            "witness(heat, coefficient=1): a simulation needs the samples of heat; give imunoise "
            "simulate --witness \"heat: RW(gamma2=1e-6)\" or --witness heat=FILE");
  EXPECT_EQ(message("WN + line(f=26, amplitude=1)"),
            "line(f=26, amplitude=1): half the sampling rate is 25 Hz");
  EXPECT_EQ(message("WN + line(f=5, amplitude=1)"), "possible");
}

TEST(Effects, AFitTakesNoSize) {
  const auto model = parse_full_model("WN + ramp(slope=-3)", Hertz{kRate});
  ASSERT_TRUE(model) << model.error().message;
  const Result<void> fits = check(model->effects[0], *subject_of({.samples = 1000}));
  ASSERT_FALSE(fits);
  EXPECT_NE(fits.error().message.find("a fit finds slope itself"), std::string::npos);
}

}  // namespace
}  // namespace imunoise
