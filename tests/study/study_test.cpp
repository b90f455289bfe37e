// The loop of a study: open, add, undo, branch; and its file.

#include "study/ladder/study.h"

#include <fmt/format.h>
#include <gtest/gtest.h>

#include <chrono>
#include <cmath>
#include <fstream>
#include <map>
#include <numeric>
#include <set>
#include <stop_token>
#include <thread>

#include "core/model/model.h"
#include "study/analysis/diagnose_series.h"
#include "study/analysis/evaluate.h"
#include "study/analysis/fit_series.h"
#include "study/ladder/study_file.h"
namespace imunoise::study {
namespace {

// Three replicates of white noise and a walk, with quantisation noise that the model lacks.
Result<std::vector<recording::Replicate>> read(const v1::StudyInput&, const std::string&) {
  constexpr Hertz kRate{50.0};
  const Model noise = *parse_model("WN(sigma2=1) + RW(gamma2=1e-5) + QN(q2=0.3)", kRate);
  std::vector<recording::Replicate> out;
  for (std::uint32_t k = 0; k < 3; ++k) {
    auto samples = std::make_shared<recording::Samples>(simulate(noise, 4096, 21, k));
    recording::Channel channel{"gyro_x", samples, 0, 4096, 1.0, 0.0, *parse_unit("rad/s"), kRate};
    out.push_back({"run" + std::to_string(k + 1), "", kRate, {channel}});
  }
  return out;
}

v1::Study opened() {
  v1::StudyRequest request;
  request.mutable_open()->set_channel("gyro_x");
  request.mutable_open()->set_model("WN + RW");
  const auto study = apply({}, request, read);
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
  const auto sought = apply(first, seek, read);
  ASSERT_TRUE(sought) << sought.error().message;
  EXPECT_EQ(sought->diagnosis().verdict(), v1::found);
  EXPECT_EQ(sought->diagnosis().candidates(0).effect(), "quantisation");

  const auto second = apply(*sought, adding(sought->diagnosis().candidates(0).term()), read);
  ASSERT_TRUE(second) << second.error().message;
  EXPECT_EQ(current_model(*second), "WN + RW + QN");
  EXPECT_FALSE(second->has_diagnosis());  // it was about another model
  EXPECT_LT(second->attempts(1).rung().unexplained(), second->attempts(0).rung().unexplained());
  EXPECT_GT(second->attempts(1).rung().log_likelihood(), 10.0);

  const auto back = apply(*second, undoing(), read);
  ASSERT_TRUE(back);
  EXPECT_EQ(current_model(*back), "WN + RW");
  EXPECT_TRUE(back->attempts(1).undone());
  EXPECT_FALSE(apply(*back, undoing(), read));

  v1::StudyRequest branch = adding("line(f=3)");
  branch.mutable_add()->set_branch_from(1);
  const auto other = apply(*back, branch, read);
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
  EXPECT_FALSE(apply(first, redoing(), read)) << "nothing was undone";
  v1::Study study = *apply(first, adding("QN"), read);
  study = *apply(study, adding("ramp"), read);
  const std::string top = current_model(study);
  study = *apply(*apply(study, undoing(), read), undoing(), read);
  EXPECT_EQ(current_model(study), "WN + RW");

  study = *apply(study, redoing(), read);
  EXPECT_EQ(study.current(), 1U);
  EXPECT_FALSE(study.attempts(1).undone());
  EXPECT_TRUE(study.attempts(2).undone());
  study = *apply(study, redoing(), read);
  EXPECT_EQ(current_model(study), top);
  EXPECT_FALSE(apply(study, redoing(), read)) << "that was the last";
}

TEST(Study, AnotherModelIsTriedBesideTheCurrentOne) {
  v1::StudyRequest request;
  request.mutable_try_model()->set_model("WN");
  const auto study = apply(opened(), request, read);
  ASSERT_TRUE(study) << study.error().message;
  EXPECT_EQ(current_model(*study), "WN");
  EXPECT_EQ(study->attempts(1).parent(), 0U);
  EXPECT_LE(study->attempts(1).rung().log_likelihood(), 0.0) << "it has fewer terms";
  request.mutable_try_model()->set_model("WM");
  EXPECT_FALSE(apply(*study, request, read));
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
  const std::vector<recording::Replicate> replicates = *read({}, "");
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
  const auto sought = apply(first, seek, read);
  ASSERT_TRUE(sought) << sought.error().message;
  const ReadInput nothing = [](const v1::StudyInput&, const std::string&) {
    return Result<std::vector<recording::Replicate>>(fail("nothing may be read"));
  };
  for (int i = 0; i < 2; ++i) {
    const v1::EffectCandidate& candidate = sought->diagnosis().candidates(i);
    const auto slow = apply(first, adding(candidate.term()), read);
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
  ASSERT_TRUE(apply(first, seek, read));
  const auto whole = Clock::now() - begin;
  for (int moment = 0; moment <= 24; ++moment) {
    std::stop_source source;
    if (moment == 0) source.request_stop();
    const std::jthread stopper([&] {
      std::this_thread::sleep_for(moment * whole / 100);
      source.request_stop();
    });
    const auto done = apply(first, seek, read, Progress({}, source.get_token()));
    ASSERT_FALSE(done) << moment;
    EXPECT_EQ(done.error().message, "stopped") << moment;
  }
}

TEST(Study, ARequestThatCannotBeDoneChangesNothing) {
  const v1::Study study = opened();
  EXPECT_FALSE(apply(study, adding("line(f=99)"), read));
  EXPECT_FALSE(apply(study, adding("XYZ"), read));
  EXPECT_FALSE(apply(study, adding("witness(temperature)"), read));
  EXPECT_FALSE(apply(study, v1::StudyRequest(), read));
  v1::StudyRequest branch = adding("QN");
  branch.mutable_add()->set_branch_from(7);
  EXPECT_FALSE(apply(study, branch, read));
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
    auto out = read(input, channel);
    out->back().channels[0].count -= 1;
    return out;
  };
  const auto next = apply(opened(), adding("QN"), other);
  ASSERT_FALSE(next);
  EXPECT_NE(next.error().message.find("the recordings changed since"), std::string::npos);
}

TEST(Study, AnAttemptTellsTheValuesOfItsEffects) {
  const auto next = apply(opened(), adding("line(f=7)"), read);
  ASSERT_TRUE(next) << next.error().message;
  const v1::Rung& rung = next->attempts(1).rung();
  ASSERT_EQ(rung.effects_size(), 1);
  EXPECT_EQ(rung.effects(0).term(), "line(f=7)");
  ASSERT_EQ(rung.effects(0).parameters_size(), 1);
  EXPECT_EQ(rung.effects(0).parameters(0).name(), "amplitude");
  EXPECT_NE(rung.fitted_model().find("sigma2="), std::string::npos) << rung.fitted_model();
  EXPECT_FALSE(apply(*next, adding("line(f=7)"), read)) << "it is there already";
}

TEST(Study, ModulationIsToldPerUnitOfItsWitness) {
  constexpr Hertz kRate{50.0};
  constexpr double kSlope = 0.3;  // of the logarithm of the variance, 1/K
  const ReadInput warmed = [&](const v1::StudyInput& input, const std::string& channel) {
    auto recordings = *read(input, channel);
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

bool tells(const v1::DiagnosisReport& report, const std::string& words) {
  return std::any_of(report.notes().begin(), report.notes().end(), [&](const std::string& note) {
    return note.find(words) != std::string::npos;
  });
}

TEST(Diagnose, TheShortestRecordingsAreLookedAt) {
  const auto whole = *read({}, "");
  for (std::size_t samples = 16; samples <= 80; samples += 3) {
    auto recordings = whole;
    for (recording::Replicate& one : recordings) one.channels[0].count = samples;
    DiagnoseOptions options;
    options.model = "WN";
    options.automatic = true;
    const auto report = diagnose_series(recordings, 0, options);
    EXPECT_TRUE(report) << samples << ": " << report.error().message;
  }
}

// A coupling behind a lag, or squared, is another one, in another unit.
TEST(Diagnose, LimitsTellWhichCouplingTheyAreOf) {
  constexpr Hertz kRate{50.0};
  auto recordings = *read({}, "");
  for (std::uint32_t k = 0; k < 3; ++k) {
    const Model own = *parse_model("WN(sigma2=1) + RW(gamma2=1e-3)", kRate);
    auto samples = std::make_shared<recording::Samples>(simulate(own, 4096, 22, k));
    recordings[k].channels.push_back(
        {"temperature", samples, 0, 4096, 1.0, 0.0, *parse_unit("K"), kRate});
  }
  DiagnoseOptions options;
  options.model = "WN + RW + QN";
  const auto report = diagnose_series(recordings, 0, options);
  ASSERT_TRUE(report) << report.error().message;
  std::map<std::string, std::string> units;
  std::set<std::string> ramps;
  for (const v1::DetectionLimit& one : report->limits()) {
    if (one.effect() == "line") {
      EXPECT_EQ(one.term(), "") << "any frequency is meant";
    }
    if (one.effect() == "rate_ramp") ramps.insert(one.term());
    if (one.witness() != "temperature") continue;
    EXPECT_TRUE(units.emplace(one.term(), one.unit()).second) << one.term() << " twice";
  }
  EXPECT_EQ(ramps, (std::set<std::string>{"ramp", "ramp(own)"}));
  EXPECT_EQ(units["witness(temperature)"], "rad/s/K");
  EXPECT_EQ(units["witness(temperature, quadratic)"], "rad/s/K²");
}

TEST(Diagnose, WhatRemainsIsToldOnceEverythingIsAdded) {
  DiagnoseOptions options;
  options.model = "WN + RW";
  options.automatic = true;
  const auto report = diagnose_series(*read({}, ""), 0, options);
  ASSERT_TRUE(report) << report.error().message;
  EXPECT_EQ(report->verdict(), v1::found);
  ASSERT_TRUE(report->has_remaining());
  EXPECT_EQ(report->remaining(), v1::none);
  EXPECT_NE(report->summary().find("no further effect is missing"), std::string::npos)
      << report->summary();
}

TEST(Diagnose, WhatStandsStillIsCutAndTold) {
  auto recordings = *read({}, "");
  auto held = std::get<std::vector<double>>(*recordings[1].channels[0].samples);
  std::fill(held.begin() + 1000, held.begin() + 1400, held[1000]);
  std::fill(held.begin() + 2000, held.begin() + 2100, held[2000]);
  recordings[1].channels[0].samples = std::make_shared<recording::Samples>(held);
  DiagnoseOptions options;
  options.model = "WN + RW";
  const auto report = diagnose_series(recordings, 0, options);
  ASSERT_TRUE(report) << report.error().message;
  ASSERT_GT(report->integrity_size(), 0);
  EXPECT_EQ(report->integrity(0).effect(), "stuck");
  EXPECT_EQ(report->integrity(0).count(), 500U);
  EXPECT_NE(report->integrity(0).sentence().find("in 2 places, the first from 20.00 s"),
            std::string::npos)
      << report->integrity(0).sentence();
  EXPECT_EQ(report->candidates(0).effect(), "stuck");
  EXPECT_EQ(report->candidates(1).effect(), "quantisation");  // what the rest lacks
  ASSERT_EQ(report->compared_before().replicates_size(), 5);
  EXPECT_EQ(report->compared_before().replicates(1).name(), "run2");
  EXPECT_EQ(report->compared_before().replicates(2).name(), "run2#2");
  EXPECT_TRUE(tells(*report, "repeats its value for 500 samples in 2 places"));
}

TEST(Diagnose, AStepAfterACutIsToldWhereItWasRecorded) {
  auto recordings = *read({}, "");
  auto held = std::get<std::vector<double>>(*recordings[1].channels[0].samples);
  std::fill(held.begin() + 1000, held.begin() + 1500, held[1000]);
  for (std::size_t t = 3000; t < held.size(); ++t) held[t] += 2.0;
  recordings[1].channels[0].samples = std::make_shared<recording::Samples>(held);
  DiagnoseOptions options;
  options.model = "WN + RW + QN";
  const auto report = diagnose_series(recordings, 0, options);
  ASSERT_TRUE(report) << report.error().message;
  const v1::EffectCandidate& step = report->candidates(1);
  ASSERT_EQ(step.effect(), "step");
  EXPECT_EQ(step.parameters(0).name(), "time_s");
  EXPECT_NEAR(step.parameters(0).value(), 60.0, 1.0);
  EXPECT_EQ(step.parameters(1).value(), 2.0);
  EXPECT_NE(step.term().find("replicate=2"), std::string::npos) << step.term();
  // The term that was printed means the same when it is read.
  const auto look = prepare_channel(recordings, 0, {});
  ASSERT_TRUE(look) << look.error().message;
  const auto with = evaluate("WN + RW + QN + " + step.term(), look->prepared, {});
  ASSERT_TRUE(with) << with.error().message;
  const auto nats = [](const v1::Rung& rung) {
    return std::accumulate(rung.heldout_nats().begin(), rung.heldout_nats().end(), 0.0);
  };
  EXPECT_NEAR(nats(*with) - nats(report->ladder(0)), step.heldout_gain_nats(), 0.5);
  // Stretches of time are those of the recording, too.
  EXPECT_NEAR(report->compared_before().times(32).from(), 30.0, 1e-9);
  EXPECT_EQ(report->compared_before().times(32).replicate(), "run2#2");
  for (const char* nowhere : {"step(replicate=2, t=25)", "step(replicate=4, t=10)"}) {
    options.model = fmt::format("WN + RW + QN + {}", nowhere);
    EXPECT_FALSE(diagnose_series(recordings, 0, options)) << nowhere;
  }
}

TEST(Diagnose, WhatClocksAndCountersShowedIsToldButIsNoVerdict) {
  auto recordings = *read({}, "");
  recordings[0].timing = {.gaps = 2, .lost = 17};
  recordings[1].timing = {.jitter = 0.25};
  recordings[2].timing = {.jitter = 0.04};
  DiagnoseOptions options;
  options.model = "WN + RW + QN";
  const auto report = diagnose_series(recordings, 0, options);
  ASSERT_TRUE(report) << report.error().message;
  ASSERT_EQ(report->integrity_size(), 2);
  EXPECT_EQ(report->integrity(0).effect(), "lost_samples");
  EXPECT_EQ(report->integrity(0).count(), 17U);
  EXPECT_EQ(report->integrity(1).effect(), "clock_jitter");
  EXPECT_EQ(report->integrity(1).replicate(), "run2");
  EXPECT_EQ(report->verdict(), v1::none);
}

TEST(Diagnose, WhatRepeatsIsMendedAndTold) {
  auto recordings = *read({}, "");
  for (recording::Replicate& one : recordings) {
    auto twice = std::get<std::vector<double>>(*one.channels[0].samples);
    for (std::size_t t = 7; t < twice.size(); t += 61) twice[t] = twice[t - 1];
    one.channels[0].samples = std::make_shared<recording::Samples>(twice);
  }
  DiagnoseOptions options;
  options.model = "WN + RW + QN";  // all there is
  const auto report = diagnose_series(recordings, 0, options);
  ASSERT_TRUE(report) << report.error().message;
  EXPECT_EQ(report->candidates(0).effect(), "duplicated_samples");
  EXPECT_TRUE(tells(*report, "each is replaced by a draw"));
  EXPECT_NE(report->summary().find("mended"), std::string::npos) << report->summary();
  EXPECT_EQ(report->ladder_size(), 1)
      << "a cause was found for what was mended: " << report->candidates(1).sentence();
}

}  // namespace
}  // namespace imunoise::study
