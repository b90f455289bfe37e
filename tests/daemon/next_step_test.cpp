#include "daemon/acquire/campaign/next_step.h"

#include <gtest/gtest.h>

namespace imunoise::acquire {
namespace {

using namespace std::chrono_literals;

const Time kMidnight = Time(std::chrono::sys_days(std::chrono::year(2026) / 3 / 1));

v1::Campaign campaign() {
  v1::Campaign out;
  out.set_name("bench");
  out.set_replicates(2);
  out.set_length_s(3600.0);
  out.set_settling_s(600.0);
  out.set_pause_s(60.0);
  return out;
}

v1::ReplicateNote note(v1::ReplicateState state, bool disturbed = false) {
  v1::ReplicateNote out;
  out.set_state(state);
  if (disturbed) out.add_disturbances();
  return out;
}

RecordingState state(std::vector<v1::ReplicateNote> notes, Time started = kMidnight) {
  const auto last = static_cast<std::uint32_t>(notes.size());
  return {started, std::move(notes), last};
}

TEST(NextStep, SettlesRecordsAndPauses) {
  Memory memory;
  Step step = next_step(campaign(), {}, memory, kMidnight);
  EXPECT_EQ(step.phase, v1::settling);
  EXPECT_TRUE(step.new_recording);
  EXPECT_EQ(step.until, kMidnight + 10min);

  memory.at_rest_since = kMidnight;
  EXPECT_EQ(next_step(campaign(), {}, memory, kMidnight + 9min).phase, v1::settling);
  step = next_step(campaign(), {}, memory, kMidnight + 10min);
  EXPECT_EQ(step.phase, v1::recording);
  EXPECT_TRUE(step.new_recording);
  EXPECT_EQ(step.replicate, 1U);
  EXPECT_EQ(step.attempt, 1U);

  memory.replicate_ended = kMidnight + 70min;
  step = next_step(campaign(), state({note(v1::complete)}), memory, kMidnight + 70min);
  EXPECT_EQ(step.phase, v1::pausing);
  EXPECT_EQ(step.until, kMidnight + 71min);
  step = next_step(campaign(), state({note(v1::complete)}), memory, kMidnight + 71min);
  EXPECT_EQ(step.phase, v1::recording);
  EXPECT_FALSE(step.new_recording);
  EXPECT_EQ(step.replicate, 2U);
  EXPECT_EQ(step.attempt, 2U);
}

TEST(NextStep, CalibratesPublishesAndIsFinished) {
  Memory memory;
  const auto done = state({note(v1::complete), note(v1::complete)});
  EXPECT_EQ(next_step(campaign(), done, memory, kMidnight).phase, v1::calibrating);
  memory.calibrated = true;
  EXPECT_EQ(next_step(campaign(), done, memory, kMidnight).phase, v1::publishing);
  memory.published = true;
  EXPECT_EQ(next_step(campaign(), done, memory, kMidnight + 1000h).phase, v1::finished);
}

TEST(NextStep, BeginsAgainFromStartToStart) {
  v1::Campaign every = campaign();
  every.mutable_schedule()->set_every_s(6 * 3600.0);
  Memory memory;
  memory.calibrated = memory.published = true;
  const auto done = state({note(v1::complete), note(v1::complete)});
  const Step wait = next_step(every, done, memory, kMidnight + 3h);
  EXPECT_EQ(wait.phase, v1::waiting);
  EXPECT_EQ(wait.until, kMidnight + 6h - 10min) << "it settles before it records";
  const Step next = next_step(every, done, memory, kMidnight + 6h - 10min);
  EXPECT_EQ(next.phase, v1::settling);
  EXPECT_EQ(next.until, kMidnight + 6h);
  EXPECT_TRUE(next.new_recording);
}

TEST(NextStep, AfterARestartItGoesOnWithTheReplicateThatWasInterrupted) {
  v1::Campaign at_once = campaign();
  at_once.set_settling_s(0.0);
  const auto cut = state({note(v1::complete), note(v1::interrupted)});
  const Step step = next_step(at_once, cut, {}, kMidnight + 100h);
  EXPECT_EQ(step.phase, v1::recording);
  EXPECT_FALSE(step.new_recording);
  EXPECT_EQ(step.replicate, 2U);
  EXPECT_EQ(step.attempt, 3U) << "what is on disk stays as it is";
  // A replicate without a note, of a manifest that was lost, is no reason to write into it.
  EXPECT_EQ(next_step(at_once, RecordingState{kMidnight, {}, 4}, {}, kMidnight).attempt, 5U);
  EXPECT_EQ(next_step(at_once, state({note(v1::open)}), {}, kMidnight).replicate, 1U);
}

TEST(NextStep, ReplicatesThatWaitedTooLongStayAlone) {
  v1::Campaign every = campaign();
  every.set_settling_s(0.0);
  every.mutable_schedule()->set_every_s(6 * 3600.0);
  const auto cut = state({note(v1::complete)});
  EXPECT_FALSE(next_step(every, cut, {}, kMidnight + 5h).new_recording);
  EXPECT_TRUE(next_step(every, cut, {}, kMidnight + 6h).new_recording);
}

TEST(NextStep, RepeatsWhatWasDisturbedAtMostSoOften) {
  v1::Campaign careful = campaign();
  careful.mutable_stillness()->set_repeat_disturbed(true);
  careful.mutable_stillness()->set_repeats(2);
  const auto knock = note(v1::complete, true);
  const auto fine = note(v1::complete);
  const auto good = [&](std::vector<v1::ReplicateNote> notes) {
    return good_replicates(careful, notes);
  };
  EXPECT_EQ(good({knock}), 0U);
  EXPECT_EQ(good({knock, knock}), 0U);
  EXPECT_EQ(good({knock, knock, knock}), 1U) << "the third is taken as it is";
  EXPECT_EQ(good({knock, fine}), 1U);
  EXPECT_EQ(good({knock, fine, knock, knock}), 1U) << "each replicate has its own repeats";
  EXPECT_EQ(good({knock, note(v1::interrupted, true), knock, knock}), 1U);
  careful.mutable_stillness()->set_repeat_disturbed(false);
  EXPECT_EQ(good({knock, knock}), 2U);
}

TEST(NextStep, OnceIsOneRecordingWhateverTheScheduleSays) {
  v1::Campaign every = campaign();
  every.set_settling_s(0.0);
  every.mutable_schedule()->set_every_s(6 * 3600.0);
  Memory memory;
  memory.calibrated = memory.published = true;
  memory.once_since = kMidnight + 1h;
  const auto before = state({note(v1::complete), note(v1::complete)});
  EXPECT_TRUE(next_step(every, before, memory, kMidnight + 1h).new_recording);
  const auto after = state({note(v1::complete), note(v1::complete)}, kMidnight + 1h);
  EXPECT_EQ(next_step(every, after, memory, kMidnight + 100h).phase, v1::finished);
}

TEST(NextStep, IsHeldUpUntilItsTimeIsOver) {
  Memory memory;
  memory.held_up_until = kMidnight + 5s;
  EXPECT_EQ(next_step(campaign(), {}, memory, kMidnight).phase, v1::held_up);
  EXPECT_EQ(next_step(campaign(), {}, memory, kMidnight + 5s).phase, v1::settling);
}

}  // namespace
}  // namespace imunoise::acquire
