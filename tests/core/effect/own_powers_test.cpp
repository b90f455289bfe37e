// Sensors that average over a window and are read at a pace of the host's own: their filter is
// found, and so are replicates that were read at another pace.

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <map>

#include "core/diagnosis/candidates.h"
#include "core/diagnosis/views/averaging_times.h"
#include "core/diagnosis/views/left_over.h"
#include "core/diagnosis/views/misfit.h"
#include "core/search/search_view.h"
#include "tests/core/diagnosis/subject_of.h"

namespace imunoise {
namespace {

constexpr std::size_t kAveragedSamples = 8192;

// Four replicates of white noise averaged over a window of `windows[k]` sampling intervals, at
// least one and at most two: neighbours correlate by 1 - 1/window, others not at all.
std::shared_ptr<const Subject> averaged(const std::vector<double>& windows, std::uint64_t seed) {
  std::vector<std::vector<double>> noise;
  for (std::size_t k = 0; k < windows.size(); ++k) {
    const double rho = 1.0 - 1.0 / windows[k];
    const double theta = rho > 0.0 ? (1.0 - std::sqrt(1.0 - 4.0 * rho * rho)) / (2.0 * rho) : 0.0;
    const MovingAverage process{1.0 / (1.0 + theta * theta), {theta}};
    noise.push_back(
        simulate(Model{{Term(process)}}, kAveragedSamples, seed, static_cast<std::uint32_t>(k)));
  }
  return subject_of({.model = "RW(gamma2=1e-5)",
                     .samples = kAveragedSamples,
                     .replicates = windows.size(),
                     .seed = seed + 1000,
                     .added = [&](std::size_t k, double seconds) {
                       return noise[k][static_cast<std::size_t>(std::lround(seconds * 50.0))];
                     }});
}

const TriedTerm& best(const Diagnosis& diagnosis) { return diagnosis.effects.at(0).tried; }

std::string added(const TriedTerm& tried) {
  if (tried.term() != nullptr) return print(*tried.term());
  return std::string(info(std::get<NoiseChange>(tried.suggestion.added).added).name);
}

// Powers of four replicates whose temperature is `kelvin`, on a straight line or not.
Diagnosis of_powers(const std::vector<double>& logarithms, const std::vector<double>& kelvin) {
  const Model white = *parse_model("WN(sigma2=1)", Hertz{50.0});
  std::vector<std::vector<double>> noise;
  for (std::uint32_t k = 0; k < 4; ++k) noise.push_back(simulate(white, 8192, 57, k));
  return diagnose(fitted(subject_of(
      {.model = "RW(gamma2=1e-5)",
       .seed = 58,
       .added =
           [&](std::size_t k, double s) {
             return std::exp(0.5 * logarithms[k]) *
                    noise[k][static_cast<std::size_t>(std::lround(s * 50.0))];
           },
       .temperature = [&](std::size_t k, double s) { return kelvin[k] + 0.01 * wave(0.4, s); }})));
}

bool could_be(const TriedTerm& tried, std::string_view cause) {
  return std::find(tried.could_be.begin(), tried.could_be.end(), cause) != tried.could_be.end();
}

TEST(OwnPowers, MayFollowAChannelThatTheirReplicatesDifferIn) {
  const std::vector<double> kelvin{290.0, 300.0, 295.0, 310.0};
  const Diagnosis straight = of_powers({0.0, 0.2, 0.1, 0.4}, kelvin);
  EXPECT_EQ(best(straight).cause, "replicate_change");
  EXPECT_TRUE(could_be(best(straight), "modulated_variance"));
  const Diagnosis crooked = of_powers({0.0, 0.2, 0.4, 0.1}, kelvin);
  EXPECT_EQ(best(crooked).cause, "replicate_change");
  EXPECT_FALSE(could_be(best(crooked), "modulated_variance"));
}

TEST(OwnPowers, AWindowThatIsNoMultipleOfTheIntervalIsAFilterOfFreeTap) {
  const Diagnosis diagnosis = diagnose(fitted(averaged({1.2, 1.2, 1.2, 1.2}, 51)));
  EXPECT_EQ(best(diagnosis).cause, "low_pass");
  EXPECT_EQ(added(best(diagnosis)), "MA");
}

TEST(OwnPowers, AWindowOfTwoIntervalsIsTheKnownFilter) {
  const Diagnosis diagnosis = diagnose(fitted(averaged({2.0, 2.0, 2.0, 2.0}, 52)));
  EXPECT_EQ(best(diagnosis).cause, "low_pass");
  EXPECT_EQ(added(best(diagnosis)), "MAVG");
}

TEST(OwnPowers, AReplicateReadAtAnotherPaceHasASpectrumOfItsOwn) {
  const auto subject = averaged({1.2, 1.2, 1.2, 1.42}, 53);
  const Diagnosis diagnosis = diagnose(fitted(subject, "MA(1) + RW"));
  EXPECT_EQ(best(diagnosis).cause, "replicate_bandwidth");
  EXPECT_EQ(added(best(diagnosis)), "own_powers(shapes)");
  const auto& own = best(diagnosis).fitted.fit.own_noise;
  ASSERT_EQ(own.size(), 4U);
  // θ of a window of 1.2 and of 1.42; its standard error is √((1 - θ²)/n) = 0.011.
  EXPECT_NEAR(values(own[0].terms[0].process)[1], 0.172, 4 * 0.011);
  EXPECT_NEAR(values(own[3].terms[0].process)[1], 0.328, 4 * 0.011);
}

TEST(OwnPowers, SpectraOfTheirOwnHideNothingThatAllReplicatesMiss) {
  const auto subject = averaged({1.2, 1.2, 1.2, 1.42}, 54);
  const Diagnosis diagnosis = diagnose(fitted(subject, "WN + RW + AR1"));
  EXPECT_NE(added(best(diagnosis)), "own_powers(shapes)");
}

TEST(OwnPowers, EqualReplicatesGetNoSpectraOfTheirOwn) {
  const Diagnosis diagnosis = diagnose(fitted(averaged({1.2, 1.2, 1.2, 1.2}, 55), "MA(1) + RW"));
  for (const RankedTerm& one : diagnosis.effects) EXPECT_NE(one.tried.cause, "replicate_bandwidth");
}

// Four replicates of white noise and a walk: where a power is not that of the others.
std::shared_ptr<const Subject> own(const std::vector<double>& white,
                                   const std::vector<double>& walk, std::uint64_t seed) {
  constexpr std::size_t kSamples = 2048;
  std::vector<std::vector<double>> noise;
  for (std::uint32_t k = 0; k < white.size(); ++k) {
    const Model model{{Term(WhiteNoise{white[k]}), Term(RandomWalk{1e-2 * walk[k]})}};
    noise.push_back(simulate(model, kSamples, seed, k));
  }
  return subject_of({.model = "WN(sigma2=1e-9)",
                     .samples = kSamples,
                     .replicates = white.size(),
                     .seed = seed + 1000,
                     .added = [&](std::size_t k, double seconds) {
                       return noise[k][static_cast<std::size_t>(std::lround(seconds * 50.0))];
                     }});
}

std::map<std::string, ReportedNumber> ratios_of(const std::shared_ptr<const Subject>& subject,
                                                const std::string& model) {
  const FittedModel with = fitted(subject, model);
  std::map<std::string, ReportedNumber> out;
  for (const ReportedNumber& one : fitted_numbers({with, 0})) out[one.name] = one;
  return out;
}

// 95 % intervals of the ratio of one replicate hold it: of 100, 95 ± 3.2 × 2.2 at least.
TEST(OwnPowers, TheRatioOfAReplicateHasItsInterval) {
  int held = 0;
  double width = 0.0;
  for (std::uint64_t seed = 1; seed <= 100; ++seed) {
    const ReportedNumber ratio = ratios_of(own({1, 1, 1, 1}, {1, 1, 1, 1}, 5700 + seed),
                                           "WN + RW + own_powers")["power ratio of replicate 1"];
    ASSERT_TRUE(ratio.lower && ratio.upper);
    held += *ratio.lower <= 1.0 && 1.0 <= *ratio.upper ? 1 : 0;
    width += std::log(*ratio.upper / *ratio.lower) / 100.0;
  }
  EXPECT_GE(held, 88);
  // The power of 2048 samples, three quarters of whose error it has on its own: √(2/2048 · ¾).
  EXPECT_NEAR(width, 2.0 * 1.96 * std::sqrt(2.0 / 2048.0 * 0.75), 0.01 * width);
}

TEST(OwnPowers, AProcessThatDiffersAloneIsNamed) {
  auto found = ratios_of(own({1, 1, 1, 1}, {1, 1, 9, 1}, 58), "WN + RW + own_powers");
  EXPECT_EQ(found.count("spread of RW"), 1U);
  ASSERT_EQ(found.count("power ratio of RW in replicate 3"), 1U);
  EXPECT_GT(found["power ratio of RW in replicate 3"].lower, 1.0);
  EXPECT_EQ(found.count("power ratio of replicate 3"), 0U);
  EXPECT_NEAR(found["power ratio of WN in replicate 3"].value, 1.0, 0.15);
}

TEST(OwnPowers, PowersThatGrowTogetherAreOneRatio) {
  auto found = ratios_of(own({1, 1, 1.5, 1}, {1, 1, 1.5, 1}, 59), "WN + RW + own_powers");
  EXPECT_EQ(found.size(), 5U);  // the spread, and a ratio a replicate
  EXPECT_EQ(found.count("spread"), 1U);
  EXPECT_GT(found["power ratio of replicate 3"].lower, 1.2);
}

// Three replicates ring at 0.4 rad, the last, faintly, at 2.2: from the noise that all share a fit
// never gets there.
std::shared_ptr<const Subject> apart(std::uint64_t seed) {
  const std::vector<Model> rings{*parse_model("RES(sigma2=0.02, r=0.99, omega=0.4)", Hertz{50.0}),
                                 *parse_model("RES(sigma2=0.004, r=0.99, omega=2.2)", Hertz{50.0})};
  std::vector<std::vector<double>> noise;
  for (std::uint32_t k = 0; k < 4; ++k)
    noise.push_back(simulate(rings[k / 3], kAveragedSamples, seed, k));
  return subject_of({.model = "WN(sigma2=1)",
                     .samples = kAveragedSamples,
                     .seed = seed + 1000,
                     .added = [&](std::size_t k, double seconds) {
                       return noise[k][static_cast<std::size_t>(std::lround(seconds * 50.0))];
                     }});
}

TEST(OwnPowers, OneTermMoreExplainsNoLess) {
  const auto subject = apart(56);
  FullModel model = *parse_full_model("WN + RES + own_powers(shapes)", subject->rate);
  set_values(model.noise.terms[0].process, std::vector<double>{1.0});
  set_values(model.noise.terms[1].process, std::vector<double>{0.02, 0.99, 0.4});
  const FittedModel plain = fit_full_model(subject, model);
  // The fit that knows where the last one rings.
  std::vector<Model> own(4, model.noise);
  set_values(own[3].terms[1].process, std::vector<double>{0.004, 0.99, 2.2});
  const JointFit known =
      joint_fit(plain.regression, plain.fit.model.noise, {}, Begin::kAnywhere, own);
  EXPECT_GT(known.log_likelihood, plain.fit.log_likelihood + 20.0);
  const Current current = current_of(plain.regression, known);
  const FittedModel ramp =
      fit_with(current, parse_full_model("WN + ramp", subject->rate)->effects[0]);
  EXPECT_GT(ramp.fit.log_likelihood, known.log_likelihood - 1e-3);
  Model start = known.model.noise;
  start.terms.emplace_back(Process(RandomWalk{1e-9}));
  const FittedModel walk = fit_with(
      current, Suggestion{.cause = "random_walk", .added = NoiseChange{start, RandomWalk{1e-9}}});
  EXPECT_GT(walk.fit.log_likelihood, known.log_likelihood - 1e-3);
}

// White noise and a walk, in replicate 2 as loud as `louder` says.
std::shared_ptr<const Subject> with_a_louder_one(double louder, std::uint64_t seed) {
  RandomStream random(seed);
  double walk = 0.0;
  return subject_of({.model = "WN(sigma2=1) + RW(gamma2=1e-4)",
                     .replicates = 3,
                     .seed = seed + 1,
                     .added = [&](std::size_t k, double) {
                       const double own = std::sqrt(louder - 1.0);
                       walk += 0.01 * random.normal();
                       return k == 1 ? own * (random.normal() + walk) : 0.0;
                     }});
}

// One replicate ten times as loud as the others decides what all share. Compared with that, true
// models failed in 44 of 100 sets. Of 16 tests 5 below 5 % are 1 in 1,000.
TEST(OwnPowers, ATrueModelFitsHoweverTheReplicatesDiffer) {
  int low = 0;
  for (std::uint64_t seed = 70; seed < 78; ++seed) {
    const FittedModel model = fitted(with_a_louder_one(10.0, 10 * seed), "WN + RW + own_powers");
    low += misfit_of(model).spectrum.p_value < 0.05 ? 1 : 0;
    low += averaging_times(model, left_over(model)).test.p_value < 0.05 ? 1 : 0;
  }
  EXPECT_LT(low, 5);
}

// All samples together have the tails of several normal laws.
TEST(OwnPowers, DifferentLevelsAreNoHeavyTails) {
  const Diagnosis diagnosis = diagnose(fitted(with_a_louder_one(5.0, 790)));
  ASSERT_FALSE(diagnosis.effects.empty());
  EXPECT_EQ(diagnosis.effects[0].tried.cause, "replicate_change");
  for (const RankedTerm& one : diagnosis.effects) {
    if (one.tried.cause == "heavy_tails") {
      EXPECT_GT(one.familywise_p, 0.05);
    }
  }
}

}  // namespace
}  // namespace imunoise
