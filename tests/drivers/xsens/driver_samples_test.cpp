// Every sample that an emulated MTi sends, through the plugin, in every protocol and format.

#include <cmath>

#include "tests/drivers/xsens/mti_fixture.h"

namespace imunoise::testing {
namespace {

using emulator::MtiMessage;

constexpr double kTwo20 = 1048576.0;
constexpr double kTwo32 = 4294967296.0;

// The number that a channel holds for a value in the device's unit.
double stored(const std::string& format, double value) {
  if (format == "float32") return static_cast<double>(static_cast<float>(value));
  if (format == "fixed12_20") return std::nearbyint(value * kTwo20);
  if (format == "fixed16_32") return std::nearbyint(value * kTwo32);
  return value;
}

struct Case {
  std::string protocol;
  std::string format;
  double scale;
  friend void PrintTo(const Case& shown, std::ostream* out) {
    *out << shown.protocol << " " << shown.format;
  }
};

class MtiFormats : public MtiTest, public ::testing::WithParamInterface<Case> {};

TEST_P(MtiFormats, EverySampleIsDeliveredAsItWasSent) {
  const auto& [protocol, format, scale] = GetParam();
  emulator::MtiOptions options;
  options.fourth_generation = protocol == "mtdata2";
  options.first_counter = 65'400;     // wraps in the middle
  options.first_ticks = 863'998'000;  // likewise
  options.field_rate_limit = 2000;
  plug_in(options);
  auto session = open({{"rate", "480"}, {"format", format}});
  ASSERT_TRUE(session) << session.error().message;
  ASSERT_TRUE((*session)->read_rows(250)) << (*session)->failure();

  const drivers::DeviceInfo& info = (*session)->device().info();
  EXPECT_EQ(info.product, options.product);
  EXPECT_EQ(info.serial, "07700123");
  EXPECT_EQ(info.firmware, "1.8.2");
  ASSERT_EQ(info.streams.size(), 1U);
  const drivers::Stream& stream = info.streams[0];
  EXPECT_EQ(stream.nominal_rate_hz, 480.0);
  EXPECT_EQ(stream.counter_maximum, 65535U);
  ASSERT_EQ(stream.channels.size(), 10U);
  EXPECT_EQ(stream.channels[0].units, "degC");

  const auto& rows = (*session)->rows();
  const auto sent = intact(rows.size());
  ASSERT_EQ(sent.size(), rows.size());
  std::int64_t days = 0;
  for (std::size_t i = 0; i < rows.size(); ++i) {
    SCOPED_TRACE(i);
    ASSERT_EQ(rows[i].counter, sent[i].counter);
    EXPECT_EQ(rows[i].flags, i == 0 ? std::uint32_t{IMUNOISE_SAMPLE_AFTER_RESTART} : 0U);
    if (i > 0) {
      EXPECT_GE(rows[i].host_time_ns, rows[i - 1].host_time_ns);
      if (sent[i].ticks < sent[i - 1].ticks) ++days;
    }
    if (protocol == "mtdata2") {
      EXPECT_EQ(rows[i].device_time_ns, (days * 864'000'000 + sent[i].ticks) * 100'000);
    }
    ASSERT_EQ(sent[i].values.size(), stream.channels.size());
    for (std::size_t c = 0; c < stream.channels.size(); ++c) {
      const auto& [name, value] = sent[i].values[c];
      EXPECT_EQ(stream.channels[c].name, name);
      EXPECT_EQ(stream.channels[c].scale_factor, scale);
      EXPECT_EQ(rows[i].numbers[c], stored(format, value)) << name;
    }
  }
  EXPECT_EQ(days, protocol == "mtdata2" ? 1 : 0);
  EXPECT_LT(rows.back().counter, rows.front().counter);  // it did wrap
  EXPECT_EQ((*session)->all_refused(), 0U);
}

INSTANTIATE_TEST_SUITE_P(
    All, MtiFormats,
    ::testing::Values(Case{"mtdata2", "float32", 1.0}, Case{"mtdata2", "fixed12_20", 1.0 / kTwo20},
                      Case{"mtdata2", "fixed16_32", 1.0 / kTwo32}, Case{"mtdata2", "float64", 1.0},
                      Case{"legacy", "float32", 1.0}, Case{"legacy", "fixed12_20", 1.0 / kTwo20},
                      Case{"legacy", "fixed16_32", 1.0 / kTwo32}),
    [](const auto& test) { return test.param.protocol + "_" + test.param.format; });

using MtiSamples = MtiTest;

TEST_F(MtiSamples, AnOutputThatTheDeviceSendsMoreSlowlyIsAStreamOfItsOwn) {
  plug_in();  // the magnetic field at 100 Hz at most
  auto session = open({{"rate", "400"}, {"output", "gyro"}, {"output", "mag"}});
  ASSERT_TRUE(session) << session.error().message;
  const auto& streams = (*session)->device().info().streams;
  ASSERT_EQ(streams.size(), 2U);
  EXPECT_EQ(streams[1].name, "imu_100hz");
  EXPECT_EQ(streams[1].nominal_rate_hz, 100.0);
  EXPECT_EQ(streams[1].counter_maximum, 0U);
  ASSERT_TRUE((*session)->read_rows(40, 1)) << (*session)->failure();
  std::size_t fast = 0;
  std::size_t slow = 0;
  for (const emulator::MtiMessage& message : intact(~std::size_t{0})) {
    if (fast == (*session)->rows(0).size() || slow == (*session)->rows(1).size()) break;
    ASSERT_EQ((*session)->rows(0)[fast].counter, message.counter);
    ASSERT_EQ((*session)->rows(0)[fast].flags & IMUNOISE_SAMPLE_AFTER_GAP, 0U);
    EXPECT_EQ((*session)->rows(0)[fast++].numbers[2], stored("float32", message.values[2].second));
    if (message.values.size() < 6) continue;
    EXPECT_EQ((*session)->rows(1)[slow].device_time_ns, message.ticks * std::int64_t{100'000});
    EXPECT_EQ((*session)->rows(1)[slow++].numbers[2], stored("float32", message.values[5].second));
  }
  EXPECT_GE(slow, 35U);
  EXPECT_GE(fast, 35U * 4);
  EXPECT_EQ((*session)->all_refused(0) + (*session)->all_refused(1), 0U);
}

// A tenth of a second in two, so that it matters not when somebody begins to listen.
class Shocks final : public emulator::SampleSource {
 public:
  emulator::Measurement measure(double time) override {
    return {.specific_force = {0.0, std::fmod(time, 0.2) > 0.1 ? 70.0 : 0.0, 0.0}};
  }
};

TEST_F(MtiSamples, ClippingAndAFailedSelfTestAreFlags) {
  emulator::MtiOptions options;
  options.self_test_passed = false;
  plug_in(options, {}, std::make_unique<Shocks>());
  auto session = open({{"output", "acc"}});
  ASSERT_TRUE(session) << session.error().message;
  ASSERT_TRUE((*session)->read_rows(60)) << (*session)->failure();
  std::size_t clipped = 0;
  for (const ReadRow& row : (*session)->rows()) {
    EXPECT_NE(row.flags & IMUNOISE_SAMPLE_SUSPECT, 0U);
    EXPECT_EQ((row.flags & IMUNOISE_SAMPLE_SATURATED) != 0, row.numbers[1] == 50.0);
    clipped += row.numbers[1] == 50.0 ? 1U : 0U;
  }
  EXPECT_GT(clipped, 20U);
  EXPECT_LT(clipped, (*session)->rows().size());
}

}  // namespace
}  // namespace imunoise::testing
