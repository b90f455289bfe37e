// The loop of a study: open, add, undo, branch; and its file.

#include "study/ladder/study.h"

#include <gtest/gtest.h>

#include <chrono>
#include <cmath>
#include <fstream>
#include <stop_token>
#include <thread>

#include "core/model/model.h"
#include "study/analysis/fit_series.h"
#include "study/ladder/study_file.h"
#include "tests/study/quantised_recording.h"

namespace imunoise::study {
namespace {

v1::Study opened() {
  v1::StudyRequest request;
  request.mutable_open()->set_channel("gyro_x");
  request.mutable_open()->set_model("WN + RW");
  const auto study = apply({}, request, read_quantised);
  EXPECT_TRUE(study) << study.error().message;
  return *study;
}

v1::StudyRequest adding(const std::string& term) {
  v1::StudyRequest request;
  request.mutable_add()->set_term(term);
  return request;
}

v1::StudyRequest undoing() {
  v1::StudyRequest request;
  request.mutable_undo();
  return request;
}

TEST(Study, WhatIsAddedMakesTheErrorFallAndCanBeTakenBack) {
  const v1::Study first = opened();
  ASSERT_EQ(first.attempts_size(), 1);
  EXPECT_EQ(first.attempts(0).rung().log_likelihood(), 0.0);

  v1::StudyRequest seek;
  seek.mutable_candidates();
  const auto sought = apply(first, seek, read_quantised);
  ASSERT_TRUE(sought) << sought.error().message;
  EXPECT_EQ(sought->diagnosis().verdict(), v1::found);
  EXPECT_EQ(sought->diagnosis().candidates(0).effect(), "quantisation");

  const auto second =
      apply(*sought, adding(sought->diagnosis().candidates(0).term()), read_quantised);
  ASSERT_TRUE(second) << second.error().message;
  EXPECT_EQ(current_model(*second), "WN + RW + QN");
  EXPECT_FALSE(second->has_diagnosis());  // it was about another model
  EXPECT_LT(second->attempts(1).rung().unexplained(), second->attempts(0).rung().unexplained());
  EXPECT_GT(second->attempts(1).rung().log_likelihood(), 10.0);

  const auto back = apply(*second, undoing(), read_quantised);
  ASSERT_TRUE(back);
  EXPECT_EQ(current_model(*back), "WN + RW");
  EXPECT_TRUE(back->attempts(1).undone());
  EXPECT_FALSE(apply(*back, undoing(), read_quantised));

  v1::StudyRequest branch = adding("line(f=3)");
  branch.mutable_add()->set_branch_from(1);
  const auto other = apply(*back, branch, read_quantised);
  ASSERT_TRUE(other) << other.error().message;
  EXPECT_EQ(other->current(), 2u);
  EXPECT_EQ(other->attempts(2).parent(), 1u);
}

// One story of estimation: a study reports the likelihood's estimate, the one of fit --estimator
// whittle, and fit's own default agrees with it within its interval.
v1::StudyRequest redoing() {
  v1::StudyRequest request;
  request.mutable_redo();
  return request;
}

TEST(Study, WhatWasTakenBackComesAgainInItsOrder) {
  const v1::Study first = opened();
  EXPECT_FALSE(apply(first, redoing(), read_quantised)) << "nothing was undone";
  v1::Study study = *apply(first, adding("QN"), read_quantised);
  study = *apply(study, adding("ramp"), read_quantised);
  const std::string top = current_model(study);
  study = *apply(*apply(study, undoing(), read_quantised), undoing(), read_quantised);
  EXPECT_EQ(current_model(study), "WN + RW");

  study = *apply(study, redoing(), read_quantised);
  EXPECT_EQ(study.current(), 1U);
  EXPECT_FALSE(study.attempts(1).undone());
  EXPECT_TRUE(study.attempts(2).undone());
  study = *apply(study, redoing(), read_quantised);
  EXPECT_EQ(current_model(study), top);
  EXPECT_FALSE(apply(study, redoing(), read_quantised)) << "that was the last";
}

TEST(Study, AnotherModelIsTriedBesideTheCurrentOne) {
  v1::StudyRequest request;
  request.mutable_try_model()->set_model("WN");
  const auto study = apply(opened(), request, read_quantised);
  ASSERT_TRUE(study) << study.error().message;
  EXPECT_EQ(current_model(*study), "WN");
  EXPECT_EQ(study->attempts(1).parent(), 0U);
  EXPECT_LE(study->attempts(1).rung().log_likelihood(), 0.0) << "it has fewer terms";
  request.mutable_try_model()->set_model("WM");
  EXPECT_FALSE(apply(*study, request, read_quantised));
}

TEST(Study, AnAttemptKeepsWhatItsFiguresAreDrawnFrom) {
  const v1::Study study = opened();
  const v1::RungPicture& picture = study.attempts(0).rung().picture();
  const v1::NoiseBudget& budget = picture.budget();
  ASSERT_EQ(picture.terms_size(), 2);
  EXPECT_EQ(study.unit(), "rad/s");
  EXPECT_EQ(study.rate_hz(), 50.0);
  for (int i = 0; i < budget.model_size(); ++i) {
    EXPECT_NEAR(picture.terms(0).variance(i) + picture.terms(1).variance(i), budget.model(i),
                1e-12 * budget.model(i));
  }
  const v1::Coefficient& walk = picture.terms(0).coefficients(0);
  EXPECT_EQ(walk.symbol(), "N");
  EXPECT_NEAR(walk.value(), std::sqrt(picture.terms(0).parameters(0).value() / 50.0),
              1e-12 * walk.value());
  EXPECT_NEAR(walk.datasheet_value(), walk.value() * 180.0 / M_PI * 60.0,
              1e-9 * walk.datasheet_value());
}

TEST(Study, ItsNumbersAreThoseOfAFitByLikelihood) {
  const v1::Rung rung = opened().attempts(0).rung();
  const std::vector<recording::Replicate> replicates = *read_quantised({}, "");
  const Series series = series_of(replicates, 0);
  FitOptions options;
  options.model = "WN + RW";
  const v1::FitReport by_moments = *fit_series(series, options);
  options.estimator = Estimator::kWhittle;
  const v1::FitReport by_likelihood = *fit_series(series, options);
  EXPECT_EQ(by_moments.estimator(), "MuGMWM");
  EXPECT_EQ(by_likelihood.estimator(), "MuGMWM + Whittle");
  EXPECT_EQ(rung.estimator(), by_likelihood.estimator());
  const Model studied = parse_model(rung.fitted_model(), Hertz{50.0}).value();
  for (int t = 0; t < 2; ++t) {
    const double value = values(studied.terms[static_cast<std::size_t>(t)].process)[0];
    const v1::Parameter& fitted = by_likelihood.terms(t).parameters(0);
    EXPECT_NEAR(value, fitted.value(), 1e-3 * (fitted.upper() - fitted.lower()));
    EXPECT_GT(value, by_moments.terms(t).parameters(0).lower());
    EXPECT_LT(value, by_moments.terms(t).parameters(0).upper());
  }
}

// What was worked out with the candidates, or tried before, is what adding would give, to the bit.
TEST(Study, WhatIsKnownIsNotWorkedOutAgain) {
  const v1::Study first = opened();
  v1::StudyRequest seek;
  seek.mutable_candidates();
  const auto sought = apply(first, seek, read_quantised);
  ASSERT_TRUE(sought) << sought.error().message;
  const ReadInput nothing = [](const v1::StudyInput&, const std::string&) {
    return Result<std::vector<recording::Replicate>>(fail("nothing may be read"));
  };
  for (int i = 0; i < 2; ++i) {
    const v1::EffectCandidate& candidate = sought->diagnosis().candidates(i);
    const auto slow = apply(first, adding(candidate.term()), read_quantised);
    const auto quick = apply(*sought, adding(candidate.term()), nothing);
    ASSERT_TRUE(slow && quick) << candidate.term();
    EXPECT_EQ(study_text(*quick), study_text(*slow)) << candidate.term();
    const auto back = apply(*quick, undoing(), nothing);
    const auto again = apply(*back, adding(candidate.term()), nothing);
    ASSERT_TRUE(again) << candidate.term();
    EXPECT_EQ(again->attempts(2).rung().SerializeAsString(),
              slow->attempts(1).rung().SerializeAsString());
  }
  EXPECT_FALSE(apply(*sought, adding("line(f=3)"), nothing)) << "known to nobody";
}

// Most moments of a search are no moment of its progress: another thread stops it. In its first
// quarter, by a search that was not stopped, it cannot be done.
TEST(Study, AStopIsHeededWheneverItComes) {
  using Clock = std::chrono::steady_clock;
  const v1::Study first = opened();
  v1::StudyRequest seek;
  seek.mutable_candidates();
  const auto begin = Clock::now();
  ASSERT_TRUE(apply(first, seek, read_quantised));
  const auto whole = Clock::now() - begin;
  for (int moment = 0; moment <= 24; ++moment) {
    std::stop_source source;
    if (moment == 0) source.request_stop();
    const std::jthread stopper([&] {
      std::this_thread::sleep_for(moment * whole / 100);
      source.request_stop();
    });
    const auto done = apply(first, seek, read_quantised, Progress({}, source.get_token()));
    ASSERT_FALSE(done) << moment;
    EXPECT_EQ(done.error().message, "stopped") << moment;
  }
}

TEST(Study, ARequestThatCannotBeDoneChangesNothing) {
  const v1::Study study = opened();
  EXPECT_FALSE(apply(study, adding("line(f=99)"), read_quantised));
  EXPECT_FALSE(apply(study, adding("XYZ"), read_quantised));
  EXPECT_FALSE(apply(study, adding("witness(temperature)"), read_quantised));
  EXPECT_FALSE(apply(study, v1::StudyRequest(), read_quantised));
  v1::StudyRequest branch = adding("QN");
  branch.mutable_add()->set_branch_from(7);
  EXPECT_FALSE(apply(study, branch, read_quantised));
}

TEST(Study, ItsFileIsReadAsItWasWritten) {
  const std::filesystem::path file = std::filesystem::path(testing::TempDir()) / "a.study";
  const auto write = [&](const std::string& text) { std::ofstream(file) << text; };
  const v1::Study study = opened();
  write(study_text(study));
  const auto again = read_study(file);
  ASSERT_TRUE(again) << again.error().message;
  EXPECT_EQ(study_text(*again), study_text(study));
  for (const char* broken :
       {"", "{}", "nonsense", R"({"version":2})", R"({"version":1,"current":3})",
        R"({"version":1,"attempts":[{"parent":0}]})", R"({"version":1,"attempts":[{}],"no":1})"}) {
    write(broken);
    EXPECT_FALSE(read_study(file)) << broken;
  }
}

TEST(Study, OtherRecordingsAreRefused) {
  const auto other = [](const v1::StudyInput& input, const std::string& channel) {
    auto out = read_quantised(input, channel);
    out->back().channels[0].count -= 1;
    return out;
  };
  const auto next = apply(opened(), adding("QN"), other);
  ASSERT_FALSE(next);
  EXPECT_NE(next.error().message.find("the recordings changed since"), std::string::npos);
}

TEST(Study, AnAttemptTellsTheValuesOfItsEffects) {
  const auto next = apply(opened(), adding("line(f=7)"), read_quantised);
  ASSERT_TRUE(next) << next.error().message;
  const v1::Rung& rung = next->attempts(1).rung();
  ASSERT_EQ(rung.effects_size(), 1);
  EXPECT_EQ(rung.effects(0).term(), "line(f=7)");
  ASSERT_EQ(rung.effects(0).parameters_size(), 1);
  EXPECT_EQ(rung.effects(0).parameters(0).name(), "amplitude");
  EXPECT_NE(rung.fitted_model().find("sigma2="), std::string::npos) << rung.fitted_model();
  EXPECT_FALSE(apply(*next, adding("line(f=7)"), read_quantised)) << "it is there already";
}

TEST(Study, ModulationIsToldPerUnitOfItsWitness) {
  constexpr Hertz kRate{50.0};
  constexpr double kSlope = 0.3;  // of the logarithm of the variance, 1/K
  const ReadInput warmed = [&](const v1::StudyInput& input, const std::string& channel) {
    auto recordings = *read_quantised(input, channel);
    for (recording::Replicate& one : recordings) {
      auto values = std::get<std::vector<double>>(*one.channels[0].samples);
      std::vector<double> kelvins(values.size());
      for (std::size_t t = 0; t < values.size(); ++t) {
        kelvins[t] = 300.0 + 2.0 * std::sin(0.003 * static_cast<double>(t));
        values[t] *= std::exp(0.5 * kSlope * (kelvins[t] - 300.0));
      }
      one.channels[0].samples = std::make_shared<recording::Samples>(std::move(values));
      one.channels.push_back({"temperature",
                              std::make_shared<recording::Samples>(std::move(kelvins)), 0, 4096,
                              1.0, 0.0, *parse_unit("K"), kRate});
    }
    return Result<std::vector<recording::Replicate>>(std::move(recordings));
  };
  v1::StudyRequest open;
  open.mutable_open()->set_channel("gyro_x");
  open.mutable_open()->set_model("WN + RW + QN + modulated(temperature)");
  const auto study = apply({}, open, warmed);
  ASSERT_TRUE(study) << study.error().message;
  const v1::EffectParameter& slope = study->attempts(0).rung().effects(0).parameters(0);
  EXPECT_EQ(slope.name(), "log_variance_slope");
  EXPECT_EQ(slope.unit(), "1/K");
  // The error is √(2/12288) over the temperature's deviation of √2 K.
  EXPECT_NEAR(slope.value(), kSlope, 4.0 * std::sqrt(2.0 / 12288.0) / std::sqrt(2.0));
}

}  // namespace
}  // namespace imunoise::study
