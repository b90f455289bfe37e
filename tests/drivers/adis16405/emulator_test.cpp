// The emulated sensor against the datasheet, word by word: what the driver's tests rely on.

#include <gtest/gtest.h>

#include <array>

#include "drivers/emulator/measurement/gaussian_source.h"
#include "drivers/emulator/sensors/adis16405.h"
#include "drivers/emulator/usb/ft232h.h"

namespace imunoise::emulator {
namespace {

using namespace std::chrono_literals;

// Round numbers in units of the datasheet's Table of output formats.
const Measurement kConstant{{0.05 * 100 * 3.14159265358979323846 / 180.0, 0.0, 0.0},
                            {0.0, 0.0, -3.33e-3 * 300 * 9.80665},
                            {0.0, 0.5e-3 * 200 * 1e-4, 0.0},
                            273.15 + 25.0 + 0.14 * 10,
                            5.0,
                            806e-6 * 500};

struct Sensor {
  GaussianSource source{kConstant, {}, 1};
  Adis16405 device{source, 1};
  Time now{};

  Sensor() { now = 300ms; }  // its power-up is over
  // One frame of words, 30 us apart from the next; returns the answers.
  std::vector<unsigned> frame(const std::vector<unsigned>& words) {
    std::vector<unsigned> out;
    device.select(now, true);
    for (const unsigned word : words) {
      const unsigned upper = byte(word >> 8U);
      out.push_back(upper << 8U | byte(word & 0xffU));
    }
    device.deselect(now);
    now += 30us;
    return out;
  }
  unsigned byte(unsigned value) {
    const unsigned out = device.exchange(static_cast<std::uint8_t>(value), now, {1e6});
    now += 8us;
    return out;
  }
  unsigned read(unsigned address) {
    frame({address << 8U});
    return frame({0})[0];
  }
  Time next_rise(Time from) {
    const Time change = device.next_change(from);
    return device.data_ready(change) ? change : device.next_change(change);
  }
  std::vector<unsigned> burst() {
    std::vector<unsigned> words(13, 0);
    words[0] = 0x3e00;
    return frame(words);
  }
};

TEST(EmulatedAdis16405, RegistersAfterAReset) {
  Sensor sensor;
  EXPECT_EQ(sensor.read(0x56), 0x4015U);
  EXPECT_EQ(sensor.read(0x36), 0x0001U);
  EXPECT_EQ(sensor.read(0x38), 0x0402U);
  EXPECT_EQ(sensor.read(0x34), 0x0006U);
  EXPECT_TRUE(sensor.device.violations().empty()) << sensor.device.violations()[0];
}

TEST(EmulatedAdis16405, WritesByTheByteAndResets) {
  Sensor sensor;
  sensor.frame({0xb804});
  sensor.frame({0xb901});
  EXPECT_EQ(sensor.read(0x38), 0x0104U);
  sensor.frame({0xbe80});  // software reset
  EXPECT_EQ(sensor.read(0x38), 0U) << "it answers while it resets";
  sensor.now += 100ms;
  EXPECT_EQ(sensor.read(0x38), 0x0402U);
}

TEST(EmulatedAdis16405, ABurstIsNewOnceAndScaledByTheDatasheet) {
  Sensor sensor;
  sensor.now = sensor.next_rise(sensor.now);
  const std::vector<unsigned> first = sensor.burst();
  ASSERT_EQ(first.size(), 13U);
  EXPECT_EQ(first[1], 0x8000U + 2068U);  // 5 V at 2.418 mV: 0x814
  EXPECT_EQ(first[2], 0x8000U + 100U);   // 5 deg/s
  EXPECT_EQ(first[3], 0x8000U);
  EXPECT_EQ(first[7], 0x8000U + (1U << 14U) - 300U);  // -1 g, 14 bits
  EXPECT_EQ(first[9], 0x8000U + 200U);
  EXPECT_EQ(first[11], 0x8000U + 10U);
  EXPECT_EQ(first[12], 0x8000U + 500U);
  const std::vector<unsigned> second = sensor.burst();  // within the same period
  EXPECT_EQ(second[2], 100U);
  EXPECT_EQ(second[12], 500U);
}

TEST(EmulatedAdis16405, DataReadyPulsesAtTheRate) {
  Sensor sensor;
  Time rise = sensor.next_rise(sensor.now);
  for (int i = 0; i < 100; ++i) {
    EXPECT_TRUE(sensor.device.data_ready(rise));
    const Time fall = sensor.device.next_change(rise);
    EXPECT_EQ(fall - rise, 150us);
    EXPECT_FALSE(sensor.device.data_ready(fall));
    const Time next = sensor.device.next_change(fall);
    EXPECT_NEAR(static_cast<double>((next - rise).count()), 1220700.0, 1.0);
    rise = next;
  }
}

TEST(EmulatedAdis16405, SelfTestTakesItsTimeAndReports) {
  Sensor sensor;
  sensor.device.faults.self_test = 0x0420;
  sensor.frame({0xb406});
  sensor.frame({0xb504});
  EXPECT_EQ(sensor.read(0x34), 0x0406U);
  sensor.now += 12ms;
  EXPECT_EQ(sensor.read(0x34), 0x0006U);
  EXPECT_EQ(sensor.burst()[2] & 0x4000U, 0x4000U) << "EA: some bit of DIAG_STAT is set";
  EXPECT_EQ(sensor.read(0x3c), 0x0420U);
  EXPECT_EQ(sensor.read(0x3c), 0U) << "reading clears it";
  EXPECT_EQ(sensor.burst()[2] & 0x4000U, 0U);
}

TEST(EmulatedAdis16405, SaysWhatTheBusDoesWrong) {
  Sensor sensor;
  sensor.device.select(sensor.now, false);
  sensor.device.exchange(0x3e, sensor.now, {3e6});
  sensor.device.deselect(sensor.now);
  sensor.device.select(sensor.now + 1us, true);
  EXPECT_EQ(
      sensor.device.violations(),
      (std::vector<std::string>{"clock low when selected: not SPI mode 3", "SPI clock too fast",
                                "a frame that is neither a word nor a burst",
                                "selected again before the stall time was over"}));
}

TEST(EmulatedFt232h, AnswersWrongOpcodesInPacketsWithStatus) {
  Sensor sensor;
  Ft232h bridge(sensor.device, "X");
  EXPECT_FALSE(bridge.control({0x77, 0, 1})) << "no such request";
  ASSERT_TRUE(bridge.control({0x0b, 0x020b, 1}));
  EXPECT_EQ(bridge.out(std::array<std::uint8_t, 1>{0xaa}), 1U);
  bridge.run(1ms);
  EXPECT_EQ(bridge.in(), (std::vector<std::uint8_t>{0x32, 0x60, 0xfa, 0xaa}));
  EXPECT_EQ(bridge.in(), std::nullopt);
  while (bridge.now() < 17ms) bridge.run(17ms);
  EXPECT_EQ(bridge.in(), (std::vector<std::uint8_t>{0x32, 0x60})) << "the latency timer";
  EXPECT_EQ(bridge.out(std::vector<std::uint8_t>(5000, 0x88)), 1024U) << "its queue is full";
}

}  // namespace
}  // namespace imunoise::emulator
