// What is hidden is found, what is not there is not. The blind trial (tests/hidden_effects) counts;
// here are single cases with fixed seeds, strong enough that chance has no part.

#include "core/diagnosis/diagnose.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <random>

#include "core/diagnosis/causes.h"
#include "core/diagnosis/missing_noise.h"
#include "core/diagnosis/useless.h"
#include "core/effects/known_effects.h"
#include "core/search/search_view.h"
#include "tests/core/diagnosis/subject_of.h"

namespace imunoise {
namespace {

// A slow swing that differs between replicates, and hums along.
double temperature(std::size_t k, double s) {
  return 2.0 * wave(0.013 + 0.002 * static_cast<double>(k), s) + wave(0.05, s + 3.0) + 0.01 * s;
}

Diagnosis of(const MadeSubject& made, const std::string& model = "WN + RW") {
  return diagnose(fitted(subject_of(made), model));
}

void expect_found(const Diagnosis& diagnosis, const std::string& effect) {
  ASSERT_FALSE(diagnosis.effects.empty());
  EXPECT_EQ(diagnosis.effects[0].tried.cause, effect);
  EXPECT_EQ(diagnosis.verdict, DiagnosisVerdict::kFound);
  ASSERT_TRUE(diagnosis.effects[0].heldout);
  EXPECT_GT(diagnosis.effects[0].heldout->total_likelihood(),
            diagnosis.heldout->total_likelihood());
}

TEST(Diagnose, NothingIsFoundWhereNothingIs) {
  const Diagnosis diagnosis = of({.seed = 3, .temperature = temperature});
  EXPECT_EQ(diagnosis.verdict, DiagnosisVerdict::kNone);
  EXPECT_FALSE(diagnosis.worth_adding);
  EXPECT_FALSE(diagnosis.limits.empty());
}

TEST(Diagnose, AWave) {
  const Diagnosis diagnosis =
      of({.seed = 4, .added = [](std::size_t, double s) { return 0.1 * wave(7.123, s); }});
  expect_found(diagnosis, "line");
  const auto& term = std::get<EffectTerm>(diagnosis.effects[0].tried.suggestion.added);
  const double error = diagnosis.effects[0].tried.suggestion.shape_error;
  EXPECT_GT(error, 0.0);
  EXPECT_LT(std::abs(term["f"] - 7.123), 4.0 * error);
}

// Its spectrum is that of a resonance that hardly any structure can have.
TEST(Diagnose, ANarrowResonanceMayBeAMachineThatStartsAndStops) {
  const auto gated = [](std::size_t k, double s) {
    return std::fmod(s + 7.0 * static_cast<double>(k), 31.0) < 14.0 ? 0.3 * wave(7.123, s) : 0.0;
  };
  const Diagnosis diagnosis = of({.seed = 17, .added = gated});
  ASSERT_FALSE(diagnosis.effects.empty());
  const RankedTerm& first = diagnosis.effects[0];
  const bool told = std::find(first.confused_with.begin(), first.confused_with.end(),
                              "switched_line") != first.confused_with.end();
  EXPECT_TRUE(first.tried.cause == "line" || told) << first.tried.cause;
  EXPECT_NE(diagnosis.verdict, DiagnosisVerdict::kNone);
}

// Of one form in all replicates, and of none that the catalogue has.
TEST(Diagnose, ASmoothCourseThatComesBackIsCommon) {
  const auto course = [](std::size_t, double s) {
    return 0.4 * (wave(0.011, s + 5.0) + 0.7 * wave(0.019, s));
  };
  const Diagnosis diagnosis = of({.seed = 18, .added = course, .temperature = temperature});
  expect_found(diagnosis, "common_course");
}

TEST(Diagnose, ATemperatureBehindALag) {
  // temperature() through a lag of 5 s.
  const auto behind = [](std::size_t k, double s) {
    return 0.5 * (2.0 * lagged_wave(0.013 + 0.002 * static_cast<double>(k), 5.0, s) +
                  lagged_wave(0.05, 5.0, s + 3.0) + 0.01 * (s - 5.0));
  };
  const Diagnosis diagnosis = of({.seed = 5, .added = behind, .temperature = temperature});
  expect_found(diagnosis, "temperature");
  const auto& term = std::get<EffectTerm>(diagnosis.effects[0].tried.suggestion.added);
  EXPECT_EQ(term.witness, "temperature");
  EXPECT_NEAR(term["lag"], 5.0, 2.0);
}

// All that two gyroscopes share lies above 6.25 Hz, at the same frequency in a replicate of half
// the length.
TEST(Diagnose, SharedVibrationOfReplicatesOfDifferentLengths) {
  const auto shared = [](double s) {
    double out = 0.0;
    for (int i = 0; i < 60; ++i) out += wave(6.3 + 0.307 * i, s + 0.17 * i * i);
    return 0.1 * out;
  };
  const auto beside = [&](std::size_t k, double s) {
    double own = 0.0;
    for (int i = 0; i < 40; ++i)
      own += wave(0.02 + 0.151 * i, s + 0.31 * i * i + 7.0 * static_cast<double>(k));
    return shared(s) + own;
  };
  const FittedModel trial =
      fitted(subject_of({.first = 4096,
                         .seed = 31,
                         .added = [&](std::size_t, double s) { return shared(s); },
                         .temperature = beside,
                         .witness = Quantity::kAngularRate}));
  const Current current = current_of(trial.regression, trial.fit);
  const SearchView view(current);
  const Effect& witness = effect_named("witness");
  double from = 0.0;
  for (const Suggestion& one : witness.search(view)) {
    const auto& term = std::get<EffectTerm>(one.added);
    if (one.cause == "common_vibration" && term["from"] > 0.0) from = term["from"];
  }
  EXPECT_NEAR(from, 6.25, 0.01);
}

// The number of suggestions is what false alarms are counted by: chance must not move it.
TEST(Diagnose, EverySearchSuggestsItsBestThoughItGainsNothing) {
  std::vector<std::size_t> counts;
  for (std::uint64_t seed = 41; seed <= 45; ++seed) {
    const FittedModel trial =
        fitted(subject_of({.samples = 2048, .seed = seed, .temperature = temperature}));
    const Current current = current_of(trial.regression, trial.fit);
    const SearchView view(current);
    std::size_t count = search_noise(current).size();
    for (const Effect* effect : known_effects()) {
      if (effect->search != nullptr) count += effect->search(view).size();
    }
    counts.push_back(count);
  }
  EXPECT_EQ(std::count(counts.begin(), counts.end(), counts.front()), 5)
      << testing::PrintToString(counts);
}

TEST(Diagnose, AStepInOneReplicate) {
  const Diagnosis diagnosis = of({.seed = 6, .added = [](std::size_t k, double s) {
                                    return k == 2 && s >= 90.0 ? 0.6 : 0.0;
                                  }});
  expect_found(diagnosis, "step");
  const auto& term = std::get<EffectTerm>(diagnosis.effects[0].tried.suggestion.added);
  EXPECT_EQ(term["replicate"], 3.0);
  EXPECT_NEAR(term["t"], 90.0, 1.0);
}

// The same each time, as a relay's would be: two levels explain it, but none is taken again.
TEST(Diagnose, AStepOfOneHeightInEachReplicate) {
  expect_found(
      of({.seed = 16,
          .added = [](std::size_t k,
                      double s) { return s >= 60.0 + 10.0 * static_cast<double>(k) ? 0.6 : 0.0; }}),
      "step");
}

TEST(Diagnose, QuantisationNoise) {
  expect_found(of({.model = "WN(sigma2=1) + RW(gamma2=1e-5) + QN(q2=0.1)", .seed = 8}),
               "quantisation");
}

// Both roots real: no resonance, and no sum of Markov processes falls off as fast.
TEST(Diagnose, NoiseBehindTwoLags) {
  const Diagnosis diagnosis =
      of({.model = "WN(sigma2=1) + RW(gamma2=1e-5) + AR2(sigma2=2e-4, rho1=0.998398, phi2=-0.873)",
          .seed = 18});
  ASSERT_FALSE(diagnosis.effects.empty());
  const TriedTerm& best = diagnosis.effects[0].tried;
  EXPECT_EQ(best.cause, "second_order");
  EXPECT_NE(diagnosis.verdict, DiagnosisVerdict::kUnknown);
  const Model& noise = best.fitted.fit.model.noise;
  const auto found = std::find_if(noise.terms.begin(), noise.terms.end(), [](const Term& term) {
    return std::holds_alternative<Ar2>(term.process);
  });
  ASSERT_NE(found, noise.terms.end());
  EXPECT_NEAR(std::get<Ar2>(found->process).rho1, 0.998398, 0.002);
  EXPECT_NEAR(std::get<Ar2>(found->process).phi2, -0.873, 0.1);
}

// A supply that wanders would look the same, and nobody recorded it. Heat is not so fast.
TEST(Diagnose, AFastMarkovProcessMayCoupleInFromWhatWasNotRecorded) {
  const Diagnosis diagnosis =
      of({.model = "WN(sigma2=1) + RW(gamma2=1e-5) + AR1(phi=0.98, sigma2=0.002)", .seed = 9});
  ASSERT_FALSE(diagnosis.effects.empty());
  EXPECT_EQ(diagnosis.effects[0].tried.cause, "gauss_markov");
  EXPECT_EQ(diagnosis.verdict, DiagnosisVerdict::kOneOf);
  for (const RankedTerm& one : diagnosis.effects) EXPECT_NE(one.tried.cause, "second_order");
  const auto& confused = diagnosis.effects[0].confused_with;
  EXPECT_EQ(std::count(confused.begin(), confused.end(), "supply_voltage"), 1);
  EXPECT_EQ(std::count(confused.begin(), confused.end(), "temperature"), 0);
}

TEST(Diagnose, OutliersAreTakenOut) {
  const Diagnosis diagnosis = of({.seed = 10, .added = [](std::size_t k, double s) {
                                    const double at = 11.0 + 30.0 * static_cast<double>(k);
                                    return std::abs(s - at) < 0.005 ? 9.0 : 0.0;
                                  }});
  expect_found(diagnosis, "outliers");
  // The threshold is one that noise itself passes once in twenty recordings.
  EXPECT_GE(diagnosis.effects[0].tried.suggestion.dof, 4.0);
  EXPECT_LE(diagnosis.effects[0].tried.suggestion.dof, 5.0);
}

TEST(Diagnose, JumpsBetweenTwoLevels) {
  const auto up = [](std::size_t k, double s) {
    return std::fmod(s + 11.0 * static_cast<double>(k), 53.0) < 20.0 ? 0.8 : 0.0;
  };
  const Diagnosis diagnosis = of({.seed = 13, .added = up});
  expect_found(diagnosis, "telegraph");
  const FullModel& model = diagnosis.effects[0].tried.fitted.fit.model;
  EXPECT_EQ(print(model), "WN + RW + telegraph");
  // A model that is given finds the same again.
  const FittedModel again = fitted(subject_of({.seed = 13, .added = up}), "WN + RW + telegraph");
  EXPECT_NEAR(again.fit.effects.value(0), 0.8, 4.0 * std::sqrt(again.fit.effects.covariance(0, 0)));
}

// A third level half-way would not show beside noise that walks.
TEST(Diagnose, FaintJumpsMayHaveMoreLevelsThanTwo) {
  const Diagnosis diagnosis =
      of({.seed = 13, .added = [](std::size_t k, double s) {
            return std::fmod(s + 11.0 * static_cast<double>(k), 53.0) < 20.0 ? 0.4 : 0.0;
          }});
  ASSERT_FALSE(diagnosis.effects.empty());
  EXPECT_EQ(diagnosis.effects[0].tried.cause, "telegraph");
  EXPECT_EQ(diagnosis.verdict, DiagnosisVerdict::kOneOf);
  EXPECT_EQ(diagnosis.effects[0].confused_with, std::vector<std::string>{"step"});
}

TEST(Diagnose, ASlowRampMayBeATemperatureThatNobodyRecorded) {
  const Diagnosis diagnosis = of({.model = "WN(sigma2=1)",
                                  .seed = 12,
                                  .added = [](std::size_t, double s) { return 0.01 * s; }},
                                 "WN");
  ASSERT_FALSE(diagnosis.effects.empty());
  EXPECT_EQ(diagnosis.effects[0].tried.cause, "rate_ramp");
  EXPECT_EQ(diagnosis.verdict, DiagnosisVerdict::kOneOf);
  const auto& with = diagnosis.effects[0].confused_with;
  EXPECT_NE(std::find(with.begin(), with.end(), "temperature"), with.end());
}

TEST(Diagnose, ATemperatureThatStoodStillIsNoSuspect) {
  const Diagnosis diagnosis = of({.model = "WN(sigma2=1)",
                                  .seed = 12,
                                  .added = [](std::size_t, double s) { return 0.01 * s; },
                                  .temperature = [](std::size_t, double) { return 300.0; }},
                                 "WN");
  ASSERT_FALSE(diagnosis.effects.empty());
  EXPECT_EQ(diagnosis.effects[0].tried.cause, "rate_ramp");
  const auto& with = diagnosis.effects[0].confused_with;
  EXPECT_EQ(std::find(with.begin(), with.end(), "temperature"), with.end());
}

TEST(Diagnose, WhatWasFoundIsGoneOnceItIsInTheModel) {
  const MadeSubject made{.seed = 4,
                         .added = [](std::size_t, double s) { return 0.1 * wave(7.123, s); }};
  const Diagnosis before = of(made);
  const Diagnosis after = diagnose(before.effects[0].tried.fitted);
  EXPECT_EQ(after.verdict, DiagnosisVerdict::kNone);
}

TEST(Diagnose, NoiseThatFollowsAWitnessIsGoneOnceItIsInTheModel) {
  std::mt19937_64 random(29);
  std::normal_distribution<double> normal;
  const auto louder = [&](std::size_t k, double s) {
    return std::exp(0.25 * temperature(k, s)) * normal(random);
  };
  const auto subject = subject_of(
      {.model = "WN(sigma2=1e-6)", .seed = 30, .added = louder, .temperature = temperature});
  const Diagnosis before = diagnose(fitted(subject, "WN"));
  ASSERT_FALSE(before.effects.empty());
  EXPECT_EQ(before.effects[0].tried.cause, "modulated_variance");
  const FittedModel with = fitted(subject, "WN + modulated(temperature)");
  const Diagnosis after = diagnose(with);
  EXPECT_FALSE(after.worth_adding);
  EXPECT_GT(after.misfit.time.p_value, 1e-3);
  EXPECT_LT(before.misfit.time.p_value, 1e-6);
}

TEST(Diagnose, OneReplicateIsProvenOnItsQuarters) {
  const Diagnosis wavy =
      of({.samples = 32768, .replicates = 1, .seed = 15, .added = [](std::size_t, double s) {
            return 0.1 * wave(7.123, s);
          }});
  expect_found(wavy, "line");
  EXPECT_EQ(wavy.heldout->nats.size(), 4U);
  const Diagnosis still = of({.samples = 32768, .replicates = 1, .seed = 16});
  EXPECT_EQ(still.verdict, DiagnosisVerdict::kNone);
  EXPECT_TRUE(still.heldout);
}

TEST(Diagnose, NoiseThatFollowsAWitnessIsJudgedOnTheQuartersOfOneReplicate) {
  const auto subject = subject_of({.replicates = 1, .seed = 18, .temperature = temperature});
  const FittedModel trial = fitted(subject, "WN + RW + modulated(temperature)");
  const std::optional<HeldOut> out = held_out(trial);
  ASSERT_TRUE(out);
  ASSERT_EQ(out->nats.size(), 4U);
  EXPECT_TRUE(std::isfinite(out->total_likelihood()));
  // A slope that is not there costs what one number costs, and no more.
  const HeldOut plain = held_out(fitted(subject)).value();
  EXPECT_LT(std::abs(out->total_likelihood() - plain.total_likelihood()), 10.0);
}

TEST(UselessTerm, GoesAndWhatIsNeededStays) {
  const auto subject =
      subject_of({.seed = 17, .added = [](std::size_t, double s) { return 0.1 * wave(7.123, s); }});
  const FittedModel loaded = fitted(subject, "WN + RW + QN + line(f=7.123) + ramp");
  std::vector<std::string> gone;
  FittedModel model = loaded;
  while (auto useless = useless_term(model, 0.01)) {
    gone.push_back(useless->term);
    EXPECT_LT(useless->loss, 7.0);
    EXPECT_LE(model.fit.log_likelihood - useless->without.fit.log_likelihood, useless->loss + 1e-9);
    model = std::move(useless->without);
  }
  std::sort(gone.begin(), gone.end());
  EXPECT_EQ(gone, (std::vector<std::string>{"QN", "ramp"}));
  EXPECT_EQ(print(model.fit.model), "WN + RW + line(f=7.123)");
  EXPECT_EQ(model.regression.coefficients().size(), 8U);
}

// Slopes of each replicate leave a walk too little to be seen, and without it their errors are far
// too small.
TEST(UselessTerm, WhatTheModelHadFromTheStartStaysWhereItHasPower) {
  const auto subject =
      subject_of({.model = "WN(sigma2=1) + RW(gamma2=1e-6)", .samples = 16384, .seed = 24});
  const FittedModel model = fitted(subject, "WN + RW + ramp(own)");
  constexpr double kLevel = 0.05;
  const auto useless = useless_term(model, kLevel);
  ASSERT_TRUE(useless);
  EXPECT_EQ(useless->term, "RW");
  const auto kept = useless_term(model, kLevel, model.fit.model.noise);
  ASSERT_TRUE(kept);
  EXPECT_EQ(kept->term, "ramp(own)");
}

TEST(Diagnose, AFewLastSamplesAreNoStep) {
  constexpr double kLast = 8187.0 / 50.0;  // s
  const auto subject = subject_of({.seed = 61, .added = [](std::size_t k, double s) {
                                     return k == 1 && s > kLast ? 12.0 : 0.0;
                                   }});
  const Diagnosis diagnosis = diagnose(fitted(subject));
  for (const RankedTerm& one : diagnosis.effects) {
    if (one.tried.cause != "step") continue;
    EXPECT_LT((*one.tried.term())[1], (8192.0 - 16.0) / 50.0) << print(*one.tried.term());
  }
}

TEST(Diagnose, NoiseBelowTheStepOfTheConverterHasNoHeavyTails) {
  const auto noise = simulate(*parse_model("WN(sigma2=1)", Hertz{50.0}), 4 * 8192, 62, 0);
  const auto subject = subject_of(
      {.model = "WN(sigma2=1e-12)", .seed = 63, .added = [&](std::size_t k, double s) {
         constexpr double kStep = 2.0;  // standard deviations
         return kStep *
                std::round(noise[8192 * k + static_cast<std::size_t>(std::lround(50.0 * s))] /
                           kStep);
       }});
  // Rounding, not what was added to make the subject.
  auto rounded = std::make_shared<Subject>(*subject);
  for (std::size_t k = 0; k < rounded->replicates(); ++k) {
    Eigen::VectorXd samples = rounded->samples[k];
    samples = (samples.array() * 1e3).round() / 1e3;
    rounded->samples[k] = std::move(samples);
  }
  const Diagnosis diagnosis = diagnose(fitted(rounded, "WN"));
  for (const RankedTerm& one : diagnosis.effects) EXPECT_NE(one.tried.cause, "heavy_tails");
}

TEST(Diagnose, MainsBelowHalfTheRateAreNoAlias) {
  constexpr Hertz kRate{200.0};
  std::vector<std::vector<double>> all;
  std::vector<Signal> replicates;
  for (std::uint32_t k = 0; k < 3; ++k) {
    all.push_back(simulate(*parse_model("WN(sigma2=1) + RW(gamma2=1e-6)", kRate), 8192, 64, k));
    for (std::size_t t = 0; t < all[k].size(); ++t)
      all[k][t] += 0.4 * wave(50.003, static_cast<double>(t) / kRate.value + k);
  }
  for (const auto& one : all)
    replicates.emplace_back(std::span<const double>(one), kRate, Quantity::kAngularRate);
  const Diagnosis diagnosis =
      diagnose(fitted(std::make_shared<const Subject>(make_subject(replicates, {}))));
  ASSERT_FALSE(diagnosis.effects.empty());
  EXPECT_EQ(diagnosis.effects[0].tried.cause, "mains_alias");
  EXPECT_EQ(cause_info("mains_alias").title, "mains frequency");
}

}  // namespace
}  // namespace imunoise
