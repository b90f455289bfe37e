// The ladder's one number, from held-out likelihoods alone.

#include "study/analysis/unexplained.h"

#include <gtest/gtest.h>

#include <cmath>
#include <vector>

namespace imunoise::study {
namespace {

constexpr std::uint32_t kScores = 40;  // 10 averaging times, 4 replicates

v1::Rung rung(const std::vector<double>& nats, double measured = 1.0) {
  v1::Rung out;
  for (const double one : nats) out.add_heldout_nats(one);
  out.set_heldout_scores(kScores);
  v1::IntegratedError& drift = *out.add_drift();
  drift.set_seconds(100.0);
  drift.set_measured(measured);
  drift.set_unit("rad");
  return out;
}

v1::DiagnosisReport ladder(const std::vector<v1::Rung>& rungs) {
  v1::DiagnosisReport out;
  for (const v1::Rung& one : rungs) *out.add_ladder() = one;
  return out;
}

TEST(Unexplained, IsOneAtTheBestModelAndCountsNatsBelowIt) {
  v1::DiagnosisReport report =
      ladder({rung({-100, -90, -110, -80}, 2.5), rung({-90, -82, -98, -70}, 1.0)});
  tell_unexplained(report, 1);
  const v1::Rung& first = report.ladder(0);
  EXPECT_DOUBLE_EQ(report.ladder(1).unexplained(), 1.0);
  EXPECT_DOUBLE_EQ(first.unexplained(), 1.0 + 2.0 * 40.0 / kScores);
  EXPECT_FALSE(first.forecast());
  // The replicates' likelihoods differ by 30 nats, their distances (10, 8, 12, 10) by 4: a sum with
  // a standard error of √(4·8/3), Student's t with 3 degrees of freedom 3.182.
  const double reach = 3.182446 * std::sqrt(4.0 * 8.0 / 3.0);
  EXPECT_NEAR(first.unexplained_lower(), 1.0 + 2.0 * (40.0 - reach) / kScores, 1e-4);
  EXPECT_NEAR(first.unexplained_upper(), 1.0 + 2.0 * (40.0 + reach) / kScores, 1e-4);
  EXPECT_FALSE(report.ladder(1).has_unexplained_lower());
  EXPECT_DOUBLE_EQ(first.drift(0).best(), 1.0);
  EXPECT_NE(first.consequence().find("2.50 times"), std::string::npos) << first.consequence();
}

// A replicate of twice the length loses twice as much: no scatter, whatever the lengths.
TEST(Unexplained, LongerReplicatesCountMore) {
  const std::vector<std::uint64_t> lengths = {60'000, 40'000, 20'000, 80'000};
  v1::DiagnosisReport report = ladder({rung({-30, -20, -10, -40}), rung({0, 0, 0, 0})});
  for (v1::Rung& one : *report.mutable_ladder())
    one.mutable_heldout_samples()->Add(lengths.begin(), lengths.end());
  tell_unexplained(report, 1);
  const v1::Rung& first = report.ladder(0);
  EXPECT_DOUBLE_EQ(first.unexplained(), 1.0 + 2.0 * 100.0 / kScores);
  EXPECT_NEAR(first.unexplained_lower(), first.unexplained(), 1e-9);
  EXPECT_NEAR(first.unexplained_upper(), first.unexplained(), 1e-9);
  EXPECT_FALSE(report.ladder(1).has_single_replicate_nats());
}

// Nine tenths of the gain in nine tenths of the samples say nothing of one replicate.
TEST(Unexplained, ALongReplicateIsNotAlone) {
  const auto single = [](const std::vector<std::uint64_t>& lengths) {
    v1::DiagnosisReport report = ladder({rung({-90, -4, -3, -3}), rung({0, 0, 0, 0})});
    for (v1::Rung& one : *report.mutable_ladder())
      one.mutable_heldout_samples()->Add(lengths.begin(), lengths.end());
    tell_unexplained(report, 1);
    return report.ladder(1).has_single_replicate_nats();
  };
  EXPECT_FALSE(single({90'000, 4'000, 3'000, 3'000}));
  EXPECT_TRUE(single({25'000, 25'000, 25'000, 25'000}));
  EXPECT_TRUE(single({}));
}

TEST(Unexplained, AWorseRungLiesAboveTheFloorAgain) {
  v1::DiagnosisReport report = ladder({rung({0, 0, 0, 0}), rung({5, 5, 5, 5}), rung({4, 5, 4, 5})});
  tell_unexplained(report, std::nullopt);
  EXPECT_DOUBLE_EQ(report.ladder(1).unexplained(), 1.0);
  EXPECT_DOUBLE_EQ(report.ladder(2).unexplained(), 1.0 + 2.0 * 2.0 / kScores);
  EXPECT_TRUE(report.ladder(1).forecast());
}

TEST(Unexplained, SizeAndSignificanceAreToldApart) {
  v1::DiagnosisReport report = ladder({rung({0, 0, 0, 0}, 1.001), rung({20, 20, 20, 20}, 1.0)});
  tell_unexplained(report, 1);
  const std::string& words = report.ladder(0).consequence();
  EXPECT_NE(words.find("far beyond chance"), std::string::npos) << words;
  EXPECT_NE(words.find("of no consequence"), std::string::npos) << words;
}

// A wave that the spectrum's half octaves do not show is not "1 % off in the spectrum".
TEST(Unexplained, TheSizeIsThatOfTheViewThatFails) {
  v1::Rung first = rung({0, 0, 0, 0}, 1.001);
  const auto add = [&first](const char* view, double value, double p) {
    v1::ErrorView& to = *first.add_views();
    to.set_view(view);
    to.set_value(value);
    to.set_p(p);
  };
  add("averaging_times", 2.0, 0.3);
  add("spectrum", 1.4, 0.6);
  add("single_waves", 16.5, 1e-9);
  const auto words = [&] {
    v1::DiagnosisReport report = ladder({first, rung({20, 20, 20, 20}, 1.0)});
    tell_unexplained(report, 1);
    return report.ladder(0).consequence();
  };
  EXPECT_TRUE(words().starts_with("A wave 16 dB over the noise: 80 nats short")) << words();
  first.mutable_views(1)->set_p(0.01);
  EXPECT_TRUE(words().starts_with("1.4 % off in the spectrum: 80 nats short")) << words();
}

TEST(Unexplained, AModelThatPredictsTooLittleIsOfConsequence) {
  v1::DiagnosisReport report = ladder({rung({0, 0, 0, 0}), rung({500, 500, 500, 500})});
  report.mutable_ladder(0)->mutable_drift(0)->set_predicted(0.05);
  report.mutable_ladder(1)->mutable_drift(0)->set_predicted(1.0);
  tell_unexplained(report, 1);
  const std::string& words = report.ladder(0).consequence();
  EXPECT_EQ(words.find("of no consequence"), std::string::npos) << words;
  EXPECT_NE(words.find("predicts 0.05 times"), std::string::npos) << words;
}

TEST(Unexplained, NoIntervalBeginsBelowTheFloor) {
  v1::DiagnosisReport report = ladder({rung({-30, -100, -3, -2}), rung({0, 0, 0, 0})});
  tell_unexplained(report, 1);
  EXPECT_DOUBLE_EQ(report.ladder(0).unexplained_lower(), 1.0);
}

TEST(Unexplained, WhatOneReplicateAloneShowsIsToldInNats) {
  v1::DiagnosisReport report = ladder({rung({0, 0, 0, 0}), rung({0.1, 60, -0.2, 0.1})});
  tell_unexplained(report, 1);
  EXPECT_NEAR(report.ladder(1).single_replicate_nats(), 60.0, 1e-9);
  EXPECT_FALSE(report.ladder(0).has_unexplained_lower());
}

TEST(Unexplained, SignificantCandidatesStandInForTheBestModel) {
  v1::DiagnosisReport report = ladder({rung({0, 0, 0, 0})});
  v1::EffectCandidate& sure = *report.add_candidates();
  sure.set_familywise_p(1e-9);
  sure.set_heldout_gain_nats(40.0);
  v1::EffectCandidate& chance = *report.add_candidates();
  chance.set_familywise_p(0.7);
  chance.set_heldout_gain_nats(90.0);
  tell_unexplained(report, std::nullopt);
  EXPECT_DOUBLE_EQ(report.ladder(0).unexplained(), 3.0);
  EXPECT_TRUE(report.ladder(0).forecast());
  EXPECT_DOUBLE_EQ(report.candidates(0).unexplained_before(), 3.0);
  EXPECT_DOUBLE_EQ(report.candidates(0).unexplained_after(), 1.0);
}

TEST(Unexplained, AMisfitThatNothingExplainsKeepsTheBestModelAboveTheFloor) {
  v1::DiagnosisReport report = ladder({rung({0, 0, 0, 0})});
  report.mutable_ladder(0)->set_promised_nats(100.0);
  tell_unexplained(report, 0);
  EXPECT_DOUBLE_EQ(report.ladder(0).unexplained(), 6.0);
  EXPECT_NE(report.ladder(0).consequence().find("100 nats"), std::string::npos);
}

TEST(Unexplained, RungsOfOldFilesStayAsTheyAre) {
  v1::Rung old;
  old.set_heldout_error(1.3);
  v1::DiagnosisReport report = ladder({old});
  tell_unexplained(report, std::nullopt);
  EXPECT_FALSE(report.ladder(0).has_unexplained());
  v1::DiagnosisReport none;
  tell_unexplained(none, std::nullopt);
  EXPECT_EQ(none.ladder_size(), 0);
}

// All attempts and previews are measured against one best model.
TEST(Unexplained, AttemptsAndPreviewsShareOneFloor) {
  v1::Study study;
  *study.add_attempts()->mutable_rung() = rung({0, 0, 0, 0});
  v1::StudyAttempt& second = *study.add_attempts();
  second.set_parent(0);
  *second.mutable_rung() = rung({5, 5, 5, 5});
  study.set_current(1);
  tell_unexplained(study);
  EXPECT_FALSE(study.has_diagnosis());
  EXPECT_DOUBLE_EQ(study.attempts(1).rung().unexplained(), 1.0);
  v1::EffectCandidate& next = *study.mutable_diagnosis()->add_candidates();
  next.set_familywise_p(1e-6);
  *next.mutable_next() = rung({15, 15, 15, 15});
  tell_unexplained(study);
  EXPECT_DOUBLE_EQ(next.next().unexplained(), 1.0);
  EXPECT_DOUBLE_EQ(study.attempts(1).rung().unexplained(), 3.0);
  EXPECT_DOUBLE_EQ(study.attempts(0).rung().unexplained(), 4.0);
  EXPECT_TRUE(study.attempts(0).rung().forecast());
}

}  // namespace
}  // namespace imunoise::study
