// What came over a device's wire, recorded beside its samples, gives the same samples again.

#include <map>

#include "tests/drivers/replay/wire/capture.h"

namespace imunoise::testing {
namespace {

struct Case {
  const char* name;
  const char* device;
  const char* format;
  std::vector<drivers::OptionText> live;
  std::vector<drivers::OptionText> replayed;
  bool times = false;  // the capture keeps the host's times, to the microsecond
  // Messages of a device that has just come back, before its driver knows it again: on a busy
  // machine some are in the wire that were no samples yet.
  std::size_t strangers = 0;
  friend void PrintTo(const Case& shown, std::ostream* out) { *out << shown.name; }
};

class WireOf : public Capture, public ::testing::WithParamInterface<Case> {
 protected:
  // A device with lively numbers whose wire is kept.
  static std::unique_ptr<RecordingSession> open_live() {
    std::vector<drivers::OptionText> options = {{"device", GetParam().device},
                                                {"effect", "fan(frequency=3, amplitude=0.4)"},
                                                {"effect", "temperature(swing=2, period=1)"}};
    options.insert(options.end(), GetParam().live.begin(), GetParam().live.end());
    auto out = RecordingSession::open(IMUNOISE_DRIVER_FOLDER, "emulated", options, true);
    if (!out) throw std::runtime_error(out.error().message);
    return std::move(*out);
  }
};

void expect_same(const drivers::Stream& a, const drivers::Stream& b) {
  EXPECT_EQ(a.name, b.name);
  EXPECT_EQ(a.counter_maximum, b.counter_maximum);
  EXPECT_EQ(a.device_time_tick_s, b.device_time_tick_s);
  EXPECT_NEAR(a.nominal_rate_hz, b.nominal_rate_hz, 0.05 * b.nominal_rate_hz);
  ASSERT_EQ(a.channels.size(), b.channels.size());
  for (std::size_t c = 0; c < a.channels.size(); ++c) {
    EXPECT_EQ(a.channels[c].name, b.channels[c].name);
    EXPECT_EQ(a.channels[c].units, b.channels[c].units);
    EXPECT_EQ(a.channels[c].type, b.channels[c].type);
    EXPECT_EQ(a.channels[c].scale_factor, b.channels[c].scale_factor);
    EXPECT_EQ(a.channels[c].add_offset, b.channels[c].add_offset);
  }
}

TEST_P(WireOf, IsReplayedToTheSameSamples) {
  const auto live = open_live();
  ASSERT_TRUE(live->read_rows(300)) << live->failure();
  write(live->wire());
  const auto again = replay(GetParam().replayed, GetParam().format);
  ASSERT_NE(again, nullptr);
  ASSERT_EQ(again->info().streams.size(), live->info().streams.size());
  for (std::size_t s = 0; s < live->info().streams.size(); ++s) {
    SCOPED_TRACE(live->info().streams[s].name);
    expect_same(again->info().streams[s], live->info().streams[s]);
    const auto& expected = live->rows(s);
    ASSERT_GT(expected.size(), 0U);
    ASSERT_TRUE(again->read_rows(expected.size(), s)) << again->failure();
    std::size_t skipped = 0;
    for (std::size_t i = 0; i < expected.size(); ++i) {
      while (skipped < GetParam().strangers &&
             again->rows(s)[i + skipped].counter != expected[i].counter) {
        ++skipped;
        ASSERT_TRUE(again->read_rows(expected.size() + skipped, s)) << again->failure();
      }
      const ReadRow& row = again->rows(s)[i + skipped];
      ASSERT_EQ(row.numbers, expected[i].numbers) << i;
      ASSERT_EQ(row.counter, expected[i].counter) << i;
      ASSERT_EQ(row.device_time_ns, expected[i].device_time_ns) << i;
      ASSERT_EQ(row.flags, expected[i].flags) << i;
      if (!GetParam().times) continue;
      const std::int64_t since = expected[i].host_time_ns - expected[0].host_time_ns;
      ASSERT_NEAR(static_cast<double>(row.host_time_ns - again->rows(s)[0].host_time_ns),
                  static_cast<double>(since), 2000.0);
    }
    EXPECT_EQ(again->all_refused(s), live->all_refused(s));
  }
}

INSTANTIATE_TEST_SUITE_P(
    Wire, WireOf,
    ::testing::Values(Case{"Mti", "xsens", "xbus", {{"rate", "200"}}, {}},
                      Case{"MtiWithBitErrors",
                           "xsens",
                           "xbus",
                           {{"fault", "bit_error(sample=40)"},
                            {"fault", "loss(sample=90, bytes=3)"},
                            {"fault", "stall(sample=150, count=7)"}},
                           {}},
                      Case{.name = "MtiUnplugged",
                           .device = "xsens",
                           .format = "xbus",
                           .live = {{"fault", "unplug(sample=100, count=20)"}},
                           .replayed = {},
                           .strangers = 5},
                      Case{
                          "Can", "can", "candump", {{"rate", "100"}}, {{"preset", "mti600"}}, true},
                      Case{"CanWithLosses",
                           "can",
                           "candump",
                           {{"fault", "loss(sample=200)"}},
                           {{"preset", "mti600"}},
                           true},
                      Case{"Adis16405",
                           "adis16405",
                           "adis16405",
                           {{"rate", "819.2"}, {"speed", "0"}},
                           {{"rate", "819.2"}}}),
    [](const auto& one) { return std::string(one.param.name); });

TEST_F(Capture, KeepsTheWiresPace) {
  auto live = RecordingSession::open(IMUNOISE_DRIVER_FOLDER, "emulated",
                                     {{"device", "adis16405"}, {"speed", "0"}}, true);
  ASSERT_TRUE(live) << live.error().message;
  ASSERT_TRUE((*live)->read_rows(210));  // 2 s
  write((*live)->wire());
  const auto session = open({{"rate", "102.4"}, {"speed", "4"}}, "adis16405");
  ASSERT_TRUE(session) << session.error().message;
  const auto begin = std::chrono::steady_clock::now();
  ASSERT_TRUE((*session)->read_rows(206));
  const std::chrono::duration<double> passed = std::chrono::steady_clock::now() - begin;
  EXPECT_GT(passed.count(), 0.48);
}

TEST_F(Capture, AWireThatNobodyWantsIsNotKept) {
  auto live = RecordingSession::open(IMUNOISE_DRIVER_FOLDER, "emulated",
                                     {{"device", "adis16405"}, {"speed", "0"}});
  ASSERT_TRUE(live) << live.error().message;
  ASSERT_TRUE((*live)->read_rows(100));
  EXPECT_TRUE((*live)->wire().empty());
}

}  // namespace
}  // namespace imunoise::testing
