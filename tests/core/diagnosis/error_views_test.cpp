// The views of a model's error: a true model lies at their floors, a missing effect shows in its
// view, and the true term takes it down to the floor.

#include "core/diagnosis/views/error_views.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <map>
#include <random>

#include "core/diagnosis/heldout.h"
#include "core/diagnosis/views/left_over.h"
#include "tests/core/diagnosis/subject_of.h"

namespace imunoise {
namespace {

double heat(std::size_t k, double s) {
  return 2.0 * wave(0.013 + 0.002 * static_cast<double>(k), s) + wave(0.05, s + 3.0) + 0.01 * s;
}

std::map<std::string, ErrorView> views_of(const FittedModel& trial) {
  std::map<std::string, ErrorView> out;
  for (const ErrorView& one : error_views(trial, left_over(trial), misfit_of(trial)))
    out.emplace(std::string(one.view), one);
  return out;
}

// The largest count that a share of 5 % passes once in 10⁴: P(X > most) < 1e-4 for X ~ B(n, 0.05).
std::size_t most_of(std::size_t n) {
  double left = 1.0;
  double p = std::pow(0.95, static_cast<double>(n));
  std::size_t k = 0;
  while ((left -= p) >= 1e-4) {
    p *= static_cast<double>(n - k) / static_cast<double>(k + 1) * 0.05 / 0.95;
    ++k;
  }
  return k;
}

TEST(ErrorViews, ATrueModelLiesAtItsFloors) {
  constexpr std::size_t kSets = 60;
  std::map<std::string, std::size_t> beyond;
  std::map<std::string, double> squares;
  for (std::size_t set = 0; set < kSets; ++set) {
    const auto views =
        views_of(fitted(subject_of({.samples = 2048, .seed = 500 + set, .temperature = heat})));
    ASSERT_EQ(views.size(), 7U);
    for (const auto& [name, view] : views) {
      if (view.value > view.chance_limit) ++beyond[name];
      EXPECT_EQ(view.value > view.chance_limit, view.p_value < 0.05) << name << " " << set;
      EXPECT_LT(view.floor, view.chance_limit);
      squares[name] += view.value * view.value / (view.floor * view.floor) / kSets;
    }
  }
  for (const auto& [name, square] : squares) {
    std::printf("%-16s beyond its limit in %zu of %zu, mean square over the floor's %.2f\n",
                name.c_str(), beyond[name], kSets, square);
    EXPECT_LE(beyond[name], most_of(kSets)) << name;
  }
  // Root mean squares: the mean of χ²/dof over 60 sets lies within 4 standard errors of 1.
  EXPECT_NEAR(squares["distribution"], 1.0, 4.0 * std::sqrt(2.0 / kSets));
  EXPECT_NEAR(squares["replicates"], 1.0, 4.0 * std::sqrt(2.0 / 3.0 / kSets));
  EXPECT_NEAR(squares["noise_over_time"], 1.0, 4.0 * std::sqrt(2.0 / 60.0 / kSets));
}

struct MissingEffect {
  const char* term;
  const char* view;  // where it shows
  MadeSubject made;
};

void PrintTo(const MissingEffect& one, std::ostream* to) { *to << one.term; }

class ErrorViewsOf : public testing::TestWithParam<MissingEffect> {};

TEST_P(ErrorViewsOf, TheMissingEffectShowsAndGoes) {
  const MissingEffect& missing = GetParam();
  const auto subject = subject_of(missing.made);
  const FittedModel without = fitted(subject);
  const FittedModel with = fitted(subject, std::string("WN + RW + ") + missing.term);
  const auto before = views_of(without);
  const auto after = views_of(with);
  const ErrorView& failing = before.at(missing.view);
  EXPECT_LT(failing.p_value, 1e-6);
  EXPECT_GT(failing.value, 2.0 * failing.floor);
  EXPECT_LT(after.at(missing.view).p_value, 1.0);
  EXPECT_LT(after.at(missing.view).value, 1.5 * after.at(missing.view).chance_limit);
  for (const auto& [name, view] : after)
    EXPECT_LT(view.value, std::max(1.1 * before.at(name).value, 1.5 * view.chance_limit)) << name;
  EXPECT_GT(held_out(with).value().total_likelihood(),
            held_out(without).value().total_likelihood() + 20.0);
}

INSTANTIATE_TEST_SUITE_P(
    Effects, ErrorViewsOf,
    testing::Values(
        MissingEffect{
            "line(f=7.123)",
            "single_waves",
            {.seed = 41, .added = [](std::size_t, double s) { return 0.15 * wave(7.123, s); }}},
        MissingEffect{"witness(temperature)",
                      "witnesses",
                      {.seed = 42,
                       .added = [](std::size_t k, double s) { return 0.3 * heat(k, s); },
                       .temperature = heat}},
        MissingEffect{
            "QN", "spectrum", {.model = "WN(sigma2=1) + RW(gamma2=1e-5) + QN(q2=0.3)", .seed = 44}},
        MissingEffect{
            "outliers(above=6)",
            "distribution",
            {.seed = 45,
             .added = [](std::size_t,
                         double s) { return std::lround(50.0 * s) % 997 == 500 ? 9.0 : 0.0; }}}),
    [](const testing::TestParamInfo<MissingEffect>& one) {
      return std::string(one.param.term).substr(0, std::string(one.param.term).find('('));
    });

// The walk, refitted, looks as a warm-up does: views of power hardly fail. What it predicts tells.
TEST(HeldOut, ShowsASlowCourseThatTheNoiseTakesIn) {
  const auto subject = subject_of(
      {.seed = 43, .added = [](std::size_t, double s) { return 3.0 * std::exp(-s / 20.0); }});
  EXPECT_GT(held_out(fitted(subject, "WN + RW + warm_up(tau=20)")).value().total_likelihood(),
            held_out(fitted(subject)).value().total_likelihood() + 20.0);
}

// Noise whose power follows `power` of a replicate and a time.
std::shared_ptr<const Subject> scaled(const Subject& plain,
                                      const std::function<double(std::size_t, double)>& power) {
  auto out = std::make_shared<Subject>(plain);
  for (std::size_t k = 0; k < out->replicates(); ++k) {
    Eigen::VectorXd samples = out->samples[k];
    for (Eigen::Index t = 0; t < samples.size(); ++t)
      samples(t) *= std::sqrt(power(k, static_cast<double>(t) / out->rate.value));
    samples.array() -= samples.mean();
    out->cosines[k] = cosine_transform(samples);
    out->samples[k] = std::move(samples);
  }
  return out;
}

TEST(ErrorViews, NoiseThatFollowsAWitnessShowsOverTime) {
  const auto plain = subject_of({.model = "WN(sigma2=1)", .seed = 46, .temperature = heat});
  const auto subject =
      scaled(*plain, [](std::size_t k, double s) { return std::exp(0.15 * heat(k, s)); });
  const FittedModel without = fitted(subject, "WN");
  const FittedModel with = fitted(subject, "WN + modulated(temperature)");
  EXPECT_LT(views_of(without).at("noise_over_time").p_value, 1e-6);
  EXPECT_GT(views_of(with).at("noise_over_time").p_value, 1e-3);
  EXPECT_GT(held_out(with).value().total_likelihood(),
            held_out(without).value().total_likelihood() + 50.0);
}

TEST(ErrorViews, PowersOfEachReplicateAreHeldOutByStretches) {
  const auto plain = subject_of({.model = "WN(sigma2=1)", .seed = 47});
  const auto loud = scaled(*plain, [](std::size_t k, double) { return k == 1 ? 1.3 : 1.0; });
  const FittedModel without = fitted(loud, "WN");
  const FittedModel with = fitted(loud, "WN + own_powers");
  EXPECT_LT(views_of(without).at("replicates").p_value, 1e-6);
  EXPECT_LT(views_of(with).at("replicates").value, views_of(with).at("replicates").floor);
  const HeldOut base = held_out(without).value();
  const HeldOut own = held_out(with).value();
  EXPECT_GT(own.total_likelihood(), base.total_likelihood() + 50.0);
  // Most where the power differs: its own nats, by log(1.3) to second order.
  EXPECT_GT(own.nats[1] - base.nats[1], own.nats[0] - base.nats[0]);
  // Powers that do not differ cost what their numbers cost.
  const double idle = held_out(fitted(plain, "WN + own_powers")).value().total_likelihood() -
                      held_out(fitted(plain, "WN")).value().total_likelihood();
  EXPECT_LT(std::abs(idle), 8.0);
}

// Each replicate is judged by noise of its own, and by a modulation that the others fitted.
TEST(HeldOut, PowersOfEachReplicateBesideNoiseThatFollowsAWitness) {
  const auto plain = subject_of({.model = "WN(sigma2=1)", .seed = 48, .temperature = heat});
  const auto subject = scaled(*plain, [](std::size_t k, double s) {
    return (k == 3 ? 1.3 : 1.0) * std::exp(0.15 * heat(k, s));
  });
  const HeldOut powers = held_out(fitted(subject, "WN + own_powers")).value();
  const HeldOut both =
      held_out(fitted(subject, "WN + own_powers + modulated(temperature)")).value();
  for (std::size_t k = 0; k < powers.nats.size(); ++k)
    EXPECT_GT(both.nats[k], powers.nats[k] + 10.0) << k;
}

// A term that is not there gains nothing on data it was not fitted to: of many, none more than
// luck. P(gain > 5 nats) of one number on one replicate is below 1e-3.
TEST(HeldOut, AWrongTermGainsNothing) {
  for (std::size_t set = 0; set < 12; ++set) {
    const auto subject = subject_of({.samples = 4096, .seed = 600 + set, .temperature = heat});
    const HeldOut base = held_out(fitted(subject)).value();
    for (const char* const wrong : {"line(f=3.3)", "witness(temperature)", "ramp", "QN",
                                    "warm_up(tau=20)", "modulated(temperature)", "own_powers"}) {
      const HeldOut with = held_out(fitted(subject, std::string("WN + RW + ") + wrong)).value();
      EXPECT_LT(with.total_likelihood() - base.total_likelihood(), 5.0) << wrong << " " << set;
    }
  }
}

}  // namespace
}  // namespace imunoise
