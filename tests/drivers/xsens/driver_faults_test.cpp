// What goes wrong on the line costs exactly the samples that it hits.

#include "tests/drivers/xsens/mti_fixture.h"

namespace imunoise::testing {
namespace {

using namespace std::chrono_literals;
using emulator::Fault;
using Kind = emulator::Fault::Kind;

class MtiFaults : public MtiTest {
 protected:
  // Opens, reads so many samples, and compares every one with what the line carried whole: all of
  // them, in order, each flagged where others are missing before it.
  void record(std::vector<Fault> faults, std::size_t count,
              std::vector<drivers::OptionText> options = {{"rate", "500"}}) {
    emulator::MtiOptions mti;
    mti.field_rate_limit = 2000;
    plug_in(mti, std::move(faults));
    auto opened = open(std::move(options));
    ASSERT_TRUE(opened) << opened.error().message;
    session_ = std::move(*opened);
    ASSERT_TRUE(session_->read_rows(count)) << session_->failure();
    const auto& rows = session_->rows();
    const auto sent = intact(rows.size());
    ASSERT_EQ(sent.size(), rows.size());
    for (std::size_t i = 0; i < rows.size(); ++i) {
      SCOPED_TRACE(i);
      ASSERT_EQ(rows[i].counter, sent[i].counter);
      for (std::size_t c = 0; c < rows[i].numbers.size(); ++c) {
        ASSERT_EQ(rows[i].numbers[c],
                  static_cast<double>(static_cast<float>(sent[i].values[c].second)));
      }
      if (i == 0) continue;
      ASSERT_GE(rows[i].host_time_ns, rows[i - 1].host_time_ns);
      const bool restart = (rows[i].flags & IMUNOISE_SAMPLE_AFTER_RESTART) != 0;
      const bool gap = (rows[i].flags & IMUNOISE_SAMPLE_AFTER_GAP) != 0;
      ASSERT_EQ(gap, !restart && sent[i].counter != sent[i - 1].counter + 1);
      restarts_ += restart ? 1U : 0U;
    }
  }
  std::size_t lost() const {
    const auto& rows = session_->rows();
    return rows.back().counter - rows.front().counter + 1 - rows.size();
  }

  std::unique_ptr<RecordingSession> session_;
  std::size_t restarts_ = 0;  // after the first
};

TEST_F(MtiFaults, AFlippedBitCostsOneSample) {
  // in a number, in the length (which then reaches over later messages), in the preamble
  record({{Kind::kBitError, 20, 1, 8 * 30 + 3},
          {Kind::kBitError, 60, 1, 8 * 3 + 7},
          {Kind::kBitError, 100, 1, 0}},
         200);
  EXPECT_EQ(lost(), 3U);
  EXPECT_EQ(session_->refused(IMUNOISE_REFUSED_CHECKSUM), 2U);  // the third is no message at all
  EXPECT_EQ(session_->all_refused(), 2U);
  EXPECT_EQ(restarts_, 0U);
}

TEST_F(MtiFaults, LostBytesCostTheirSample) {
  record({{Kind::kLoss, 30, 5, 20}, {Kind::kLoss, 31, 1, 0}, {Kind::kLoss, 90, 40, 2}}, 200);
  EXPECT_EQ(lost(), 3U);
  EXPECT_GE(session_->refused(IMUNOISE_REFUSED_CHECKSUM), 2U);
  EXPECT_EQ(restarts_, 0U);
}

TEST_F(MtiFaults, AShortStallIsAGap) {
  record({{Kind::kStall, 50, 100, 0}}, 200);
  EXPECT_EQ(lost(), 100U);
  EXPECT_EQ(session_->all_refused(), 0U);
  EXPECT_TRUE(session_->disconnections().empty());
}

TEST_F(MtiFaults, LateSamplesAreNotLostAndAreDatedBack) {
  record({{Kind::kLate, 50, 40, 0}}, 200);
  EXPECT_EQ(lost(), 0U);
  EXPECT_EQ(session_->all_refused(), 0U);
  // 41 samples came at once, in at most a few pieces; they span some of their 80 ms.
  const auto& rows = session_->rows();
  EXPECT_GE(rows[90].host_time_ns - rows[50].host_time_ns, 10'000'000);
}

TEST_F(MtiFaults, NoRestartIsToldWhenItIsOpened) {
  record({}, 20);
  EXPECT_EQ(session_->notes().find("restarted"), std::string::npos) << session_->notes();
}

TEST_F(MtiFaults, UnpluggedAndBack) {
  record({{Kind::kUnplug, 40, 150, 0}, {Kind::kUnplug, 90, 100, 0}}, 150);
  EXPECT_EQ(session_->disconnections().size(), 2U);
  EXPECT_NE(session_->disconnections().front().find("plug the device in again"), std::string::npos)
      << session_->disconnections().front();
  EXPECT_EQ(restarts_, 2U);
  EXPECT_NE(session_->notes().find("the device is back"), std::string::npos) << session_->notes();
  EXPECT_EQ(mti_->writes(), 1U);  // it still had its configuration
}

TEST_F(MtiFaults, SilenceIsLookedInto) {
  record({{Kind::kStall, 40, 1100, 0}}, 100);  // 2.2 s
  ASSERT_EQ(session_->disconnections().size(), 1U);
  EXPECT_NE(session_->disconnections()[0].find("powered"), std::string::npos);
  EXPECT_EQ(restarts_, 1U);
}

TEST_F(MtiFaults, CancelAndCloseWhileItIsAway) {
  record({{Kind::kUnplug, 30, 1'000'000, 0}}, 30);
  ASSERT_TRUE(session_->read_until([&] { return !session_->disconnections().empty(); }));
  std::jthread canceller([&] {
    std::this_thread::sleep_for(50ms);
    session_->device().cancel();
  });
  drivers::SampleBlock block = session_->device().make_block(10);
  const auto start = RecordingSession::Clock::now();
  EXPECT_EQ(*session_->device().read(1h, block), drivers::ReadOutcome::kCancelled);
  canceller.join();
  session_.reset();
  EXPECT_LT(RecordingSession::Clock::now() - start, 10s);
}

}  // namespace
}  // namespace imunoise::testing
