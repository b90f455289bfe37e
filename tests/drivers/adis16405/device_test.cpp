// An emulated sensor through the driver: every sample that it took, and what a start-up refuses.

#include "drivers/plugin/device.h"

#include <gtest/gtest.h>

#include <cmath>

#include "drivers/host/services.h"
#include "tests/drivers/adis16405/rig.h"

namespace imunoise::testing {
namespace {

using namespace std::chrono_literals;
using drivers::ReadOutcome;
using drivers::adis16405::Choice;
using drivers::adis16405::kCp2130Id;
using drivers::adis16405::kFt232hId;
using drivers::adis16405::Settings;

constexpr double kDegree = 3.14159265358979323846 / 180.0;

TEST(Adis16405, EverySampleAsItWasTaken) {
  Rig rig;
  rig.open();
  ASSERT_EQ(rig.read(5000), ReadOutcome::kSamples);
  for (const Stream stream : {kImu, kMagnetometer, kHousekeeping}) {
    const Received& got = rig.received[stream];
    expect_stretch(got.rows, rig.taken(stream));
    EXPECT_GE(got.rows.size(), 4999U);
    EXPECT_EQ(got.flags[0], std::uint32_t{IMUNOISE_SAMPLE_AFTER_RESTART});
    EXPECT_EQ(got.flagged(~0U), 1U);
    for (const std::uint64_t count : got.refused) EXPECT_EQ(count, 0U);
  }
  EXPECT_TRUE(rig.notes.empty()) << rig.notes.front();
  EXPECT_TRUE(rig.sensor.violations().empty()) << rig.sensor.violations().front();
}

TEST(Adis16405, HostTimesFollowTheSamples) {
  Rig rig;
  rig.open();
  ASSERT_EQ(rig.read(1000), ReadOutcome::kSamples);
  const Received& got = rig.received[kImu];
  const std::size_t before = expect_stretch(got.rows, rig.taken(kImu));
  for (std::size_t i = 0; i < got.rows.size(); ++i) {
    const std::int64_t taken = rig.bus.host_time_ns(rig.sensor.taken()[before + i].time);
    ASSERT_GE(got.times[i], taken + 208'000) << i;  // 26 bytes at 1 MHz
    ASSERT_LE(got.times[i], taken + 230'000) << i;
  }
}

TEST(Adis16405, SaysWhatItIs) {
  Rig rig;
  rig.open();
  const drivers::DeviceInfo& info = rig.device->info();
  EXPECT_EQ(info.product, "ADIS16405");
  EXPECT_EQ(info.serial, "FT0001");
  ASSERT_EQ(info.streams.size(), 3U);
  EXPECT_EQ(info.streams[kImu].name, "imu");
  EXPECT_EQ(info.streams[kImu].channels[5].name, "acc_z");
  EXPECT_EQ(info.streams[kMagnetometer].channels[0].name, "mag_x");
  EXPECT_EQ(info.streams[kHousekeeping].channels[1].name, "temperature");
  EXPECT_NEAR(info.streams[kImu].nominal_rate_hz, 819.2, 0.01);
}

// The numbers mean what the source said, at every range. The source draws the rate about x with a
// mean of 0.1 rad/s and a deviation of 0.05 rad/s.
TEST(Adis16405, ScalesFollowTheRange) {
  for (const unsigned sens_avg : {0x0402U, 0x0202U, 0x0104U}) {
    Rig rig;
    rig.open({"any", "", false, {static_cast<std::uint16_t>(sens_avg)}});
    ASSERT_EQ(rig.read(2000), ReadOutcome::kSamples);
    double sum = 0.0;
    for (const Counts& row : rig.received[kImu].rows) sum += row[0];
    const drivers::Channel& channel = rig.device->info().streams[kImu].channels[0];
    ASSERT_EQ(channel.units, "deg/s");
    const double mean =
        sum / static_cast<double>(rig.received[kImu].rows.size()) * channel.scale_factor * kDegree;
    EXPECT_NEAR(mean, 0.1, 5.0 * 0.05 / std::sqrt(2000.0)) << std::hex << sens_avg;
    // 14 bits with a sign: full scale is 8192 counts at a quarter more than the range's name.
    const double range = (sens_avg >> 8U) * 75.0;
    EXPECT_NEAR(channel.scale_factor, range / 6000.0, 1e-12);
  }
}

TEST(Adis16405, SlowRatesKeepTheSlowClock) {
  Rig rig;
  rig.open({"any", "", false, {0x0402, 0x000f, true}});  // 102.4 Hz: low power, 0.3 MHz
  ASSERT_EQ(rig.read(300), ReadOutcome::kSamples);
  expect_stretch(rig.received[kImu].rows, rig.taken(kImu));
  EXPECT_NEAR(rig.device->info().streams[kImu].nominal_rate_hz, 102.4, 0.01);
  EXPECT_TRUE(rig.sensor.violations().empty()) << rig.sensor.violations().front();
  const std::vector<std::int64_t>& times = rig.received[kImu].times;
  EXPECT_NEAR(static_cast<double>(times[299] - times[0]) / 299.0, 1e9 / 102.4, 1e4);
}

// Without data-ready most bursts are stale and many are torn, but no sample is lost or repeated.
class Polled : public ::testing::TestWithParam<drivers::usb::Id> {};

TEST_P(Polled, LosesNothing) {
  Rig rig(GetParam());
  rig.open({"any", "", true, {}});
  ASSERT_EQ(rig.read(3000), ReadOutcome::kSamples);
  for (const Stream stream : {kImu, kMagnetometer, kHousekeeping}) {
    const Received& got = rig.received[stream];
    expect_stretch(got.rows, rig.taken(stream));
    EXPECT_GT(got.refused[IMUNOISE_REFUSED_STALE], 100U);
    EXPECT_EQ(got.refused[IMUNOISE_REFUSED_MALFORMED], 0U);
    EXPECT_EQ(got.flagged(~0U), 1U);
  }
  std::size_t torn = 0;
  for (const emulator::SentBurst& burst : rig.sensor.sent()) {
    // ND of the first and of the last word of the inertial channels
    if ((burst.bytes[4] >> 7U) != (burst.bytes[14] >> 7U)) ++torn;
  }
  EXPECT_GT(torn, 100U) << "nothing was torn: the test shows nothing";
  EXPECT_TRUE(rig.sensor.violations().empty()) << rig.sensor.violations().front();
}

// Outputs that have waited since the sensor's start are all new, but may be of two samples.
TEST_P(Polled, BeginsWithAWholeSample) {
  for (int phase = 0; phase < 40; ++phase) {
    Rig rig(GetParam());
    rig.open({"any", "", true, {}});
    const emulator::Time end = rig.bridge->now() + phase * 61us;  // of a period of 1221
    while (rig.bridge->now() < end) rig.bridge->run(end);
    ASSERT_EQ(rig.read(5), ReadOutcome::kSamples);
    for (const Stream stream : {kImu, kMagnetometer, kHousekeeping}) {
      expect_stretch(rig.received[stream].rows, rig.taken(stream));
    }
  }
}

INSTANTIATE_TEST_SUITE_P(Bridges, Polled, ::testing::Values(kFt232hId, kCp2130Id));

// What a start-up refuses.

struct Refusal {
  int code;
  std::string text;
};

Refusal refusal(Rig& rig, const Choice& choice = {}) {
  try {
    rig.open(choice);
  } catch (const plugin::DeviceError& error) {
    return {error.code(), error.what()};
  }
  return {IMUNOISE_OK, "nothing was refused"};
}

void expect_refusal(const Refusal& got, int code, const std::vector<std::string>& words) {
  EXPECT_EQ(got.code, code) << got.text;
  for (const std::string& word : words) {
    EXPECT_NE(got.text.find(word), std::string::npos) << word << " is missing in: " << got.text;
  }
}

TEST(Adis16405Start, NothingIsPluggedIn) {
  Rig rig;
  rig.bus.unplug();
  expect_refusal(refusal(rig), IMUNOISE_NOT_FOUND, {"no USB-SPI bridge", "0403:6014", "cable"});
}

TEST(Adis16405Start, AnotherBridgeOrSerialNumber) {
  Rig rig;
  expect_refusal(refusal(rig, {"cp2130"}), IMUNOISE_NOT_FOUND, {"no USB-SPI bridge"});
  expect_refusal(refusal(rig, {"any", "FT9999"}), IMUNOISE_NOT_FOUND, {"FT9999", "FT0001"});
  EXPECT_EQ(refusal(rig, {"ft232h", "FT0001"}).code, IMUNOISE_OK);
}

TEST(Adis16405Start, NoPermission) {
  Rig rig;
  rig.bus.set_forbidden(true);
  expect_refusal(refusal(rig), IMUNOISE_NO_ACCESS, {"FT0001", "permission"});
}

TEST(Adis16405Start, WrongProduct) {
  Rig rig;
  rig.sensor.faults.product_id = 0x4010;
  expect_refusal(refusal(rig), IMUNOISE_BAD_DEVICE, {"0x4010", "ADIS16400", "wires"});
}

TEST(Adis16405Start, NobodyAnswers) {
  Rig rig;
  rig.sensor.faults.dead = true;
  expect_refusal(refusal(rig), IMUNOISE_BAD_DEVICE, {"no answer", "5 V", "DOUT"});
}

TEST(Adis16405Start, SelfTestFails) {
  Rig rig;
  rig.sensor.faults.self_test = 0x2020;  // accelerometer x, self-test
  expect_refusal(refusal(rig), IMUNOISE_BAD_DEVICE,
                 {"self-test failed", "acc_x", "0x2020", "self_test=false"});
  EXPECT_EQ(refusal(rig, {"any", "", false, {0x0402, 0x0001, false}}).code, IMUNOISE_OK);
}

TEST(Adis16405Start, RegistersThatForget) {
  Rig rig;
  rig.sensor.faults.forgets_writes = true;
  Settings settings{0x0204, 0x0001, false};
  expect_refusal(refusal(rig, {"any", "", false, settings}), IMUNOISE_BAD_DEVICE,
                 {"SENS_AVG", "0x0402", "0x0204"});
}

TEST(Adis16405Start, SupplyIsNoted) {
  Rig rig;
  rig.sensor.faults.self_test = 0x0001;
  EXPECT_EQ(refusal(rig).code, IMUNOISE_OK);
  EXPECT_TRUE(rig.noted("supply_below_4.75_V"));
}

// A bus with two bridges.
class TwoBridges final : public drivers::usb::Bus {
 public:
  std::vector<drivers::usb::Address> find(std::span<const drivers::usb::Id> /*ids*/) override {
    return {{kFt232hId, "1-1", "FT0001"}, {kFt232hId, "1-2", "FT0002"}};
  }
  std::unique_ptr<drivers::usb::Handle> open(const drivers::usb::Address& address) override {
    throw plugin::DeviceError(IMUNOISE_NO_ACCESS, "chose " + address.serial);
  }
};

TEST(Adis16405Start, ASerialNumberChoosesAmongSeveral) {
  drivers::DeviceHandlers none;
  const auto open = [&](const std::string& serial) -> Refusal {
    try {
      drivers::adis16405::Adis16405Device(std::make_shared<TwoBridges>(), {"any", serial},
                                          plugin::Host(&drivers::host_services(), &none));
    } catch (const plugin::DeviceError& error) {
      return {error.code(), error.what()};
    }
    return {};
  };
  expect_refusal(open(""), IMUNOISE_BAD_OPTION, {"serial=", "FT0001", "FT0002"});
  expect_refusal(open("FT0002"), IMUNOISE_NO_ACCESS, {"chose FT0002"});
}

}  // namespace
}  // namespace imunoise::testing
