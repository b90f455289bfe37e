// What is known of a replicate while it is recorded.

#include <gtest/gtest.h>

#include <cmath>
#include <random>

#include "daemon/live/live_board.h"

namespace imunoise::live {
namespace {

constexpr std::int64_t kStart = 1'700'000'000'000'000'000;  // ns
constexpr double kRate = 100.0;

v1::RecordedDevice device() {
  v1::RecordedDevice out;
  out.set_name("imu0");
  v1::RecordedStream& stream = *out.add_streams();
  stream.set_name("imu");
  stream.set_rate_hz(kRate);
  const auto add = [&](const char* name, const char* dtype, const char* units, double scale) {
    v1::RecordedChannel& channel = *stream.add_channels();
    channel.set_name(name);
    channel.set_dtype(dtype);
    channel.set_units(units);
    channel.set_scale_factor(scale);
  };
  add("gyro_x", "<i2", "deg/s", 0.05);
  add("temperature", "<f8", "degC", 1.0);
  return out;
}

// Rows of noise of ten counts, at 30 °C and so much more each second.
class Source {
 public:
  explicit Source(double warming = 0.0) : warming_(warming) {}

  recording::Block block(std::size_t rows) {
    recording::Block out{0, recording::empty_rows(device().streams(0))};
    for (std::size_t i = 0; i < rows; ++i, ++at_) {
      const double t = static_cast<double>(at_) / kRate;
      out.rows.host_time.push_back(kStart + std::llround(t * 1e9));
      out.rows.flags.push_back(0);
      std::get<std::vector<std::int16_t>>(out.rows.channels[0])
          .push_back(static_cast<std::int16_t>(std::lround(10.0 * normal_(engine_))));
      std::get<std::vector<double>>(out.rows.channels[1]).push_back(30.0 + warming_ * t);
    }
    out.rows.received = rows;
    return out;
  }
  void skip(std::size_t rows) { at_ += rows; }

 private:
  double warming_;
  std::size_t at_ = 0;
  std::mt19937_64 engine_{11};
  std::normal_distribution<double> normal_;
};

bool warns(const v1::LiveDevice& state, v1::LiveConcern concern) {
  return std::any_of(state.warnings().begin(), state.warnings().end(),
                     [&](const auto& one) { return one.concern() == concern; });
}

// Numbers in pieces of 70,000, one gap between each two.
TEST(LiveVariance, IsThatOfTheWholeWithinWhatGapsAndMeansCost) {
  std::mt19937_64 engine(5);
  std::normal_distribution<double> normal;
  LiveVariance live(Hertz{kRate}, 0.5);
  double walk = 0.0;
  constexpr std::size_t kSamples = 700'000;
  for (std::size_t i = 0; i < kSamples; ++i) {
    if (i % 70'000 == 0) live.gap();
    walk += 0.01 * normal(engine);
    live.push(1e6 + walk + normal(engine));
  }
  const std::vector<KnownScale> known = live.known();
  ASSERT_EQ(known.size(), 16U) << "up to 2^16 of the 70,000 samples of a piece";
  for (std::size_t i = 0; i < known.size(); ++i) {
    const double two_m = std::exp2(static_cast<double>(i + 1));
    EXPECT_DOUBLE_EQ(known[i].tau_s, two_m / kRate);
    // SCIENCE: ν = σ²/2m of white noise, γ² (m² + 1/2)... of a walk, per m: (2 m² + 1) / (12 m).
    const double m = two_m / 2.0;
    const double truth = 0.25 * (1.0 / two_m + 1e-4 * (2.0 * m * m + 1.0) / (12.0 * m));
    const double deviations = (known[i].variance / truth - 1.0) / std::sqrt(2.0 / known[i].degrees);
    EXPECT_LT(std::abs(deviations), 4.0) << two_m;
    EXPECT_NEAR(known[i].degrees, 10.0 * (70'000.0 - two_m) / two_m, 20.0) << two_m;
  }
}

TEST(LiveVariance, AMomentAfterTheBeginningItKnowsShortTimes) {
  LiveVariance live(Hertz{kRate}, 1.0);
  EXPECT_TRUE(live.known().empty());
  for (double x : {1.0, 3.0, 2.0, 5.0}) live.push(x);
  const std::vector<KnownScale> known = live.known();
  ASSERT_EQ(known.size(), 2U);
  EXPECT_DOUBLE_EQ(known[0].variance, (4.0 + 1.0 + 9.0) / 3.0 / 4.0);
  EXPECT_DOUBLE_EQ(known[1].variance, (7.0 - 4.0) * (7.0 - 4.0) / 16.0);
}

// Rows whose numbers count up from 0, in counts of 0.05 °/s.
recording::Block counted(int from, int rows) {
  recording::Block out{0, recording::empty_rows(device().streams(0))};
  for (int i = from; i < from + rows; ++i) {
    out.rows.host_time.push_back(kStart + i * 10'000'000LL);
    out.rows.flags.push_back(0);
    std::get<std::vector<std::int16_t>>(out.rows.channels[0])
        .push_back(static_cast<std::int16_t>(i));
    std::get<std::vector<double>>(out.rows.channels[1]).push_back(i == 5 ? NAN : 20.0);
  }
  return out;
}

TEST(SampleRings, HoldTheLeastAndTheGreatestOfEachRange) {
  constexpr double kCount = 0.05 * M_PI / 180.0;  // rad/s
  SampleRings rings(device().streams(0));
  rings.take(counted(0, 3).rows);
  recording::Block rest = counted(3, 8);
  rest.rows.flags[2] = recording::kLostBefore;
  rings.take(rest.rows);
  const auto four = rings.ranges(4, 0, {"gyro_x"});
  ASSERT_TRUE(four) << four.error().message;
  EXPECT_EQ(four->next(), 2U) << "the third is not complete";
  EXPECT_EQ(four->begin_ns(), kStart);
  ASSERT_EQ(four->time_s_size(), 2);
  EXPECT_NEAR(four->time_s(1), 0.04, 1e-9);
  EXPECT_EQ(four->gaps(0), 1U) << "within a range";
  ASSERT_EQ(four->channels_size(), 1);
  EXPECT_EQ(four->channels(0).units(), "rad/s");
  EXPECT_FLOAT_EQ(four->channels(0).lower(1), static_cast<float>(4.0 * kCount));
  EXPECT_FLOAT_EQ(four->channels(0).upper(1), static_cast<float>(7.0 * kCount));
  const auto each = rings.ranges(0, 9, {});
  ASSERT_EQ(each->time_s_size(), 2);
  EXPECT_EQ(each->next(), 11U);
  EXPECT_FLOAT_EQ(each->channels(1).lower(0), 293.15F) << "K";
  EXPECT_FLOAT_EQ(rings.ranges(1, 5, {"temperature"})->channels(0).lower(0), 293.15F)
      << "what is no number repeats the one before";
}

TEST(SampleRings, KeepTheLatestAndSayWhatTheyHave) {
  SampleRings rings(device().streams(0));
  rings.take(counted(0, 5000).rows);
  const auto all = rings.ranges(1, 0, {});
  EXPECT_EQ(all->time_s_size(), 1023);
  EXPECT_NEAR(all->time_s(0), 39.77, 1e-9);
  EXPECT_EQ(rings.ranges(4096, 0, {})->time_s_size(), 1);
  EXPECT_EQ(rings.ranges(1, 5000, {})->time_s_size(), 0);
  EXPECT_EQ(rings.ranges(1, 1'000'000, {})->time_s_size(), 0);
  EXPECT_NE(rings.ranges(3, 0, {}).error().message.find("1, 4, 16"), std::string::npos);
  EXPECT_NE(rings.ranges(1, 0, {"gyro_y"}).error().message.find("gyro_y"), std::string::npos);
}

TEST(LiveDevice, TellsRateMissingSamplesAndTemperatureOfEachStream) {
  LiveDevice live(device());
  Source source;
  live.take(source.block(500));
  source.skip(7);
  recording::Block after = source.block(500);
  after.rows.flags[0] = recording::kLostBefore;
  live.take(after);
  const v1::LiveDevice state = live.state();
  ASSERT_EQ(state.streams_size(), 1);
  const v1::LiveStream& stream = state.streams(0);
  EXPECT_EQ(stream.stream(), "imu");
  EXPECT_EQ(stream.nominal_hz(), kRate);
  EXPECT_EQ(stream.missing(), 7U);
  EXPECT_EQ(stream.gaps(), 1U);
  EXPECT_NEAR(stream.rate_hz(), 500.0 / 5.07, 0.01) << "over the time since the first block";
  EXPECT_NEAR(stream.temperature_k(), 303.15, 1e-9);
  v1::GetLiveSamplesRequest request;
  EXPECT_EQ(live.samples(request)->stream(), "imu");
  request.set_stream("other");
  EXPECT_NE(live.samples(request).error().message.find("other"), std::string::npos);
}

// 256 of the 6000 samples of a minute are a range: 23.4 of them.
TEST(LiveDevice, ShowsTheLastMinuteOfAnAngularRate) {
  LiveDevice live(device());
  Source source;
  live.take(source.block(1'000));
  EXPECT_EQ(live.state().last_minute().lower_size(), 3) << "complete ranges";
  for (int i = 0; i < 10; ++i) live.take(source.block(1'000));
  recording::Block block = source.block(256 * 43 - 11'000);
  std::get<std::vector<std::int16_t>>(block.rows.channels[0]).back() = -900;
  live.take(block);
  const v1::RangeChannel shown = live.state().last_minute();
  EXPECT_EQ(shown.channel(), "gyro_x");
  EXPECT_EQ(shown.units(), "rad/s");
  ASSERT_EQ(shown.lower_size(), 24);
  ASSERT_EQ(shown.upper_size(), 24);
  EXPECT_NEAR(shown.lower(23), -900 * 0.05 * M_PI / 180.0, 1e-6);
  EXPECT_GT(shown.lower(22), -100 * 0.05 * M_PI / 180.0);
}

TEST(LiveDevice, TellsScalesAndHowLongTheyTake) {
  LiveDevice live(device());
  Source source;
  for (int i = 0; i < 100; ++i) live.take(source.block(100));
  const v1::LiveDevice state = live.state();
  EXPECT_EQ(state.samples(), 10'000U);
  EXPECT_NEAR(state.elapsed_s(), 100.0, 0.1);
  EXPECT_TRUE(state.warnings().empty()) << state.DebugString();
  ASSERT_EQ(state.channels_size(), 1);
  EXPECT_EQ(state.channels(0).channel(), "gyro_x");
  EXPECT_EQ(state.channels(0).units(), "rad/s");
  const v1::LiveScale& first = state.channels(0).scales(0);
  EXPECT_DOUBLE_EQ(first.tau_s(), 0.02);
  // White noise of 10 counts of 0.05 °/s: deviation σ/√2.
  EXPECT_NEAR(first.deviation(), 0.5 * M_PI / 180.0 / std::sqrt(2.0), 2e-4);
  EXPECT_LT(first.lower(), first.deviation());
  EXPECT_GT(first.upper(), first.deviation());
  EXPECT_EQ(first.enough_in_s(), 0.0);
  // τ = 20.48 s: 100 s are 4 of its 17 degrees of freedom.
  const v1::LiveScale& slow = state.channels(0).scales(10);
  EXPECT_DOUBLE_EQ(slow.tau_s(), 20.48);
  EXPECT_NEAR(slow.enough_in_s(), 18.0 * 20.48 - 100.0, 3.0);
  EXPECT_GT(slow.upper() / slow.lower(), 2.0);
  EXPECT_EQ(state.outlook(),
            "averaging times up to 5.12 s are known within a factor of two; 10 s in 1 min 21 s, "
            "100 s in 28 min 21 s, 1000 s in 4 h 58 min 21 s");
}

// What kEnoughDegrees promises.
TEST(LiveDevice, EnoughIsAFactorOfTwo) {
  LiveDevice live(device());
  Source source;
  for (int i = 0; i < 7400; ++i) live.take(source.block(10));
  const v1::LiveDevice state = live.state();
  for (const v1::LiveScale& one : state.channels(0).scales()) {
    EXPECT_EQ(one.upper() / one.lower() < 2.02, one.enough_in_s() < 0.5) << one.tau_s();
  }
}

// A device that died is not shown as it was when it lived.
TEST(LiveDevice, TellsThatNoSamplesCome) {
  using std::chrono::seconds;
  LiveDevice live(device());
  Source source;
  const Steady::time_point begin{seconds(1000)};
  live.take(source.block(2'000), begin);
  EXPECT_FALSE(warns(live.state(begin + seconds(2)), v1::silent));
  const v1::LiveDevice state = live.state(begin + seconds(41));
  ASSERT_TRUE(warns(state, v1::silent)) << state.DebugString();
  EXPECT_EQ(state.warnings(0).sentence(), "imu: no samples for 41 s");
  EXPECT_EQ(state.streams(0).rate_hz(), 0.0);
  EXPECT_EQ(state.streams(0).missing(), 4'100U);
  live.take(source.block(100), begin + seconds(42));
  EXPECT_FALSE(warns(live.state(begin + seconds(43)), v1::silent));
}

TEST(LiveDevice, WarnsOfWhatCanStillBeMended) {
  LiveDevice live(device());
  Source source(3.0 / 3600.0);
  live.take(source.block(6'000));
  EXPECT_TRUE(live.warnings().empty());
  recording::Block block = source.block(100);
  std::get<std::vector<std::int16_t>>(block.rows.channels[0])[7] = 32767;
  block.rows.flags[50] = recording::kLostBefore;
  block.rows.received += 3;
  block.rows.refused = {{recording::Refused::kChecksum, "", 3}};
  live.take(block);
  v1::LiveDevice state = live.state();
  EXPECT_TRUE(warns(state, v1::saturated)) << state.DebugString();
  const auto lost = std::find_if(state.warnings().begin(), state.warnings().end(),
                                 [](const auto& one) { return one.concern() == v1::lost_samples; });
  ASSERT_NE(lost, state.warnings().end());
  EXPECT_NE(lost->sentence().find("3 samples rejected, samples missing once in the last minutes"),
            std::string::npos)
      << lost->sentence();
  EXPECT_EQ(state.refused(), 3U);
  EXPECT_EQ(state.gaps(), 1U);
  EXPECT_FALSE(warns(state, v1::warming)) << "too early to say";
  EXPECT_FALSE(state.has_past_warning()) << "they hold still";
  live.take(source.block(30'000));
  state = live.state();
  EXPECT_FALSE(warns(state, v1::saturated)) << "a minute later that is over";
  EXPECT_EQ(state.past_warning().sentence(), "imu: 3 samples rejected");
  EXPECT_EQ(state.past_warning().since_ns(), kStart + 60'990'000'000) << "the end of the block";
  ASSERT_TRUE(warns(state, v1::warming));
  EXPECT_NE(
      state.warnings(0).sentence().find("temperature: the temperature rises by 3.0 K an hour"),
      std::string::npos)
      << state.warnings(0).sentence();
  block = source.block(6'200);
  for (auto& count : std::get<std::vector<std::int16_t>>(block.rows.channels[0])) count = 4;
  live.take(block);
  EXPECT_TRUE(warns(live.state(), v1::stuck));
}

TEST(LiveBoard, ShowsReplicatesWhileTheyLast) {
  LiveBoard board;
  EXPECT_TRUE(board.state().empty());
  acquire::ReplicatePlan plan;
  plan.folder = "bench/a";
  plan.replicate = 3;
  plan.duration = std::chrono::duration<double>(3600.0);
  LiveReplicate& replicate = board.of("bench");
  replicate.begin(plan, {device()});
  Source source;
  recording::Block block = source.block(1000);
  block.rows.flags[500] = recording::kLostBefore;
  replicate.take(0, block);
  const auto state = board.state();
  ASSERT_EQ(state.size(), 1U);
  EXPECT_EQ(state[0].campaign(), "bench");
  EXPECT_EQ(state[0].recording(), "bench/a");
  EXPECT_EQ(state[0].replicate(), 3U);
  EXPECT_EQ(state[0].length_s(), 3600.0);
  EXPECT_EQ(state[0].devices(0).samples(), 1000U);
  const auto told = board.new_warnings();
  ASSERT_EQ(told.size(), 1U);
  EXPECT_EQ(told[0].find("bench: imu0: imu: samples missing once"), 0U) << told[0];
  EXPECT_TRUE(board.new_warnings().empty()) << "once";
  replicate.join(device());
  replicate.take(1, source.block(500));
  EXPECT_EQ(board.state()[0].devices(1).samples(), 500U);
  replicate.end();
  EXPECT_TRUE(board.state().empty());
  EXPECT_TRUE(board.new_warnings().empty());
}

TEST(LiveBoard, TellsWhatTheDiskDoes) {
  LiveBoard board;
  LiveReplicate& replicate = board.of("bench");
  replicate.begin({}, {device()});
  recording::RecorderState recorder;
  recorder.counts = {{{100, 60, {{recording::Refused::kOverrun, "", 30}}}}};
  recorder.disks.resize(1);
  replicate.watch([&] { return recorder; });
  const auto now = Steady::now();
  v1::LiveDevice state = board.state()[0].devices(0);
  EXPECT_EQ(state.received(), 100U);
  EXPECT_EQ(state.stored(), 60U);
  EXPECT_EQ(state.discarded(), 30U);
  EXPECT_EQ(state.disk_trouble(), "");
  EXPECT_FALSE(board.trouble("bench", now).has_value());

  recorder.disks[0].call = recording::DiskCall{"sync", "/rec/a/000001.journal", now};
  EXPECT_FALSE(board.trouble("bench", now + kHangsAfter / 2).has_value());
  replicate.beat();
  auto trouble = board.trouble("bench", now + kHangsAfter);
  ASSERT_TRUE(trouble.has_value());
  EXPECT_TRUE(trouble->hangs);
  EXPECT_EQ(trouble->since, now);
  EXPECT_EQ(trouble->what.find("the disk hangs: sync of /rec/a/000001.journal"), 0U)
      << trouble->what;

  recorder.disks[0].call.reset();
  recorder.disks[0].trouble = recording::DiskTrouble{{"/rec/a: Input/output error"}, now, 0};
  trouble = board.trouble("bench", now);
  ASSERT_TRUE(trouble.has_value());
  EXPECT_FALSE(trouble->hangs);
  EXPECT_NE(board.state()[0].devices(0).disk_trouble().find("Input/output error (since 20"),
            std::string::npos);

  recorder.disks[0].trouble.reset();
  trouble = board.trouble("bench", Steady::now() + kHangsAfter);
  ASSERT_TRUE(trouble.has_value()) << "its thread does nothing";
  EXPECT_TRUE(trouble->hangs);
  replicate.end();
  EXPECT_FALSE(board.trouble("bench", Steady::now() + kHangsAfter).has_value());
  EXPECT_FALSE(board.trouble("another", Steady::now()).has_value());
}

}  // namespace
}  // namespace imunoise::live
