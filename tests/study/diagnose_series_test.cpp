// Diagnoses of recordings: limits, what remains, defects of samples, places in cut recordings.

#include "study/analysis/diagnose_series.h"

#include <fmt/format.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <map>
#include <numeric>
#include <set>

#include "core/model/model.h"
#include "study/analysis/evaluate.h"
#include "tests/study/quantised_recording.h"

namespace imunoise::study {
namespace {

bool tells(const v1::DiagnosisReport& report, const std::string& words) {
  return std::any_of(report.notes().begin(), report.notes().end(), [&](const std::string& note) {
    return note.find(words) != std::string::npos;
  });
}

TEST(Diagnose, TheShortestRecordingsAreLookedAt) {
  const auto whole = *read_quantised({}, "");
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
  auto recordings = *read_quantised({}, "");
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
    if (one.effect() == "gauss_markov") {
      EXPECT_EQ(one.parameter(), "sigma2");
      EXPECT_TRUE(one.term().starts_with("AR1(phi=")) << "a power has no meaning without a shape";
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
  const auto report = diagnose_series(*read_quantised({}, ""), 0, options);
  ASSERT_TRUE(report) << report.error().message;
  EXPECT_EQ(report->verdict(), v1::found);
  ASSERT_TRUE(report->has_remaining());
  EXPECT_EQ(report->remaining(), v1::none);
  EXPECT_NE(report->summary().find("no further effect is missing"), std::string::npos)
      << report->summary();
}

TEST(Diagnose, WhatStandsStillIsCutAndTold) {
  auto recordings = *read_quantised({}, "");
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

// Gaps cut a recording; its warm-up goes on behind them.
TEST(Diagnose, AWarmUpGoesOnBehindAGap) {
  constexpr double kTau = 20.0;  // s
  auto recordings = *read_quantised({}, "");
  for (recording::Replicate& one : recordings) {
    auto warm = std::get<std::vector<double>>(*one.channels[0].samples);
    for (std::size_t t = 0; t < warm.size(); ++t)
      warm[t] += 2.0 * std::exp(-static_cast<double>(t) / (kTau * one.rate.value));
    one.channels[0].samples = std::make_shared<recording::Samples>(warm);
  }
  recordings.insert(recordings.begin() + 1, recordings.front());
  recordings[0].channels[0].count = 600;
  recordings[1].channels[0].begin = 650;
  recordings[1].channels[0].count = 3446;
  recordings[1].origin = {0, 650};
  recordings[2].origin = {1, 0};
  recordings[3].origin = {2, 0};
  DiagnoseOptions options;
  options.model = "WN + RW + QN";
  const auto report = diagnose_series(recordings, 0, options);
  ASSERT_TRUE(report) << report.error().message;
  const v1::EffectCandidate& found = report->candidates(0);
  ASSERT_EQ(found.effect(), "warm_up") << found.term();
  EXPECT_EQ(found.term().find("own"), std::string::npos) << found.term();
  EXPECT_NEAR(found.parameters(0).value(), kTau, 4.0);
}

TEST(Diagnose, AStepAfterACutIsToldWhereItWasRecorded) {
  auto recordings = *read_quantised({}, "");
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
  auto recordings = *read_quantised({}, "");
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
  auto recordings = *read_quantised({}, "");
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
