// The driver adis16405 as it is shipped, with libusb, usbfs and ftdi_sio of a real kernel, against
// emulated bridges that are plugged into vhci_hcd. scenarios/usb.sh prepares the kernel.

#include <gtest/gtest.h>

#include <algorithm>
#include <cstdio>
#include <cstdlib>
#include <filesystem>
#include <optional>
#include <thread>

#include "drivers/emulator/usb/cp2130.h"
#include "drivers/emulator/usb/ft232h.h"
#include "tests/drivers/adis16405/installed_plugin.h"
#include "tests/hil/usbip_port.h"

namespace imunoise::testing {
namespace {

using namespace std::chrono_literals;
using drivers::ReadOutcome;

constexpr double kRate = 819.2;  // Hz

bool until_true(std::chrono::seconds patience, const auto& condition) {
  const auto end = std::chrono::steady_clock::now() + patience;
  while (!condition()) {
    if (std::chrono::steady_clock::now() > end) return false;
    std::this_thread::sleep_for(20ms);
  }
  return true;
}

bool serial_port_is_there() { return std::filesystem::exists("/dev/ttyUSB0"); }

// A sensor behind a bridge that is plugged into a port of the kernel.
template <class Bridge>
struct Plugged {
  Plugged(const std::string& serial, unsigned port, std::uint64_t seed)
      : source({}, {{1.0, 1.0, 1.0}, {9.0, 9.0, 9.0}, {1e-4, 1e-4, 1e-4}, 9.0, 1.0, 1.0}, seed),
        sensor(source, seed),
        bridge(sensor, serial),
        usb(bridge, port) {}

  std::vector<Counts> taken() {
    const auto held = usb.lock();
    return imu_counts(sensor);
  }

  emulator::GaussianSource source;
  emulator::Adis16405 sensor;
  Bridge bridge;
  UsbIpPort usb;
};
using Ft232h = Plugged<emulator::Ft232h>;
using Cp2130 = Plugged<emulator::Cp2130>;

class UsbOfTheKernel : public ::testing::Test {
 protected:
  void SetUp() override {
    if (std::getenv("IMUNOISE_VHCI") == nullptr) {
      GTEST_SKIP() << "SKIPPED: tests/hil/run.sh runs this in a virtual machine";
    }
  }

  // Waits until the kernel has enumerated it, and its own driver has taken it.
  void plug_in(const std::string& serial = "FT0042") {
    sensor_.emplace(serial, 0, 7);
    ASSERT_TRUE(until_true(20s, serial_port_is_there)) << "ftdi_sio does not take the FT232H";
  }
  void open(const std::vector<drivers::OptionText>& options = {}) {
    auto opened = open_plugin(options);
    ASSERT_TRUE(opened) << opened.error().message;
    device_ = std::move(*opened);
  }
  ReadOutcome read(std::size_t more) {
    return read_imu(*device_, received_[kImu].rows.size() + more, received_);
  }
  // All that was read, in order; prints and returns the holes.
  std::size_t holes(const std::vector<Counts>& taken) {
    const std::size_t out = expect_in_order(received_[kImu].rows, taken);
    std::printf("%zu of %zu samples read, %zu holes, %zu marked as gaps, %zu as restarts\n",
                received_[kImu].rows.size(), taken.size(), out,
                received_[kImu].flagged(IMUNOISE_SAMPLE_AFTER_GAP),
                received_[kImu].flagged(IMUNOISE_SAMPLE_AFTER_RESTART));
    std::fflush(stdout);
    return out;
  }
  void expect_away(const std::string& why) {
    ASSERT_EQ(read(100'000), ReadOutcome::kDisconnected);
    EXPECT_NE(device_->disconnection().find(why), std::string::npos) << device_->disconnection();
  }
  void expect_back() {
    ASSERT_EQ(read(400), ReadOutcome::kSamples);
    EXPECT_EQ(received_[kImu].flagged(IMUNOISE_SAMPLE_AFTER_RESTART), 2U);
    EXPECT_LE(holes(sensor_->taken()), 1 + received_[kImu].flagged(IMUNOISE_SAMPLE_AFTER_GAP));
  }

  std::optional<Ft232h> sensor_;
  std::unique_ptr<drivers::Device> device_;  // closed before its cable is pulled
  std::array<Received, 3> received_;
};

TEST_F(UsbOfTheKernel, EverySampleAsItWasTaken) {
  plug_in();
  open();
  EXPECT_EQ(device_->info().serial, "FT0042");
  EXPECT_FALSE(serial_port_is_there()) << "ftdi_sio still has it";
  ASSERT_EQ(read(4096), ReadOutcome::kSamples);
  EXPECT_EQ(holes(sensor_->taken()), 0U);
  const Received& imu = received_[kImu];
  const double seconds = static_cast<double>(imu.times.back() - imu.times.front()) * 1e-9;
  const double rate = static_cast<double>(imu.times.size() - 1) / seconds;
  std::printf("%.1f samples a second\n", rate);
  EXPECT_NEAR(rate, kRate, 0.02 * kRate);
  EXPECT_TRUE(sensor_->sensor.violations().empty()) << sensor_->sensor.violations().front();
  device_.reset();
  EXPECT_TRUE(until_true(10s, serial_port_is_there)) << "the kernel's driver does not get it back";
}

TEST_F(UsbOfTheKernel, AHaltedEndpoint) {
  plug_in();
  open();
  ASSERT_EQ(read(200), ReadOutcome::kSamples);
  sensor_->usb.halt_in();
  expect_away("refuses a transfer");
  expect_back();
}

TEST_F(UsbOfTheKernel, AShortPacket) {
  plug_in();
  open();
  ASSERT_EQ(read(200), ReadOutcome::kSamples);
  sensor_->usb.lose_byte();
  expect_away("bytes were lost");
  expect_back();
}

TEST_F(UsbOfTheKernel, UnpluggedAndPluggedIn) {
  plug_in();
  open();
  ASSERT_EQ(read(200), ReadOutcome::kSamples);
  sensor_->usb.unplug();
  expect_away("FT0042");
  sensor_->usb.plug();
  ASSERT_TRUE(until_true(20s, serial_port_is_there)) << "ftdi_sio does not take it again";
  expect_back();
}

TEST_F(UsbOfTheKernel, ADelayLosesNothing) {
  plug_in();
  open();
  ASSERT_EQ(read(400), ReadOutcome::kSamples);
  sensor_->usb.hold_up(60ms);
  ASSERT_EQ(read(400), ReadOutcome::kSamples);
  EXPECT_EQ(holes(sensor_->taken()), 0U);
  const std::vector<std::int64_t>& times = received_[kImu].times;
  EXPECT_TRUE(std::is_sorted(times.begin(), times.end()));
}

TEST_F(UsbOfTheKernel, ASensorThatFallsSilentIsStartedAgain) {
  plug_in();
  open();
  ASSERT_EQ(read(200), ReadOutcome::kSamples);
  {
    const auto held = sensor_->usb.lock();
    sensor_->sensor.faults.stalled = true;
  }
  ASSERT_EQ(read(400), ReadOutcome::kSamples);
  EXPECT_EQ(received_[kImu].flagged(IMUNOISE_SAMPLE_AFTER_RESTART), 2U);
  EXPECT_LE(holes(sensor_->taken()), 1 + received_[kImu].flagged(IMUNOISE_SAMPLE_AFTER_GAP));
}

TEST_F(UsbOfTheKernel, TwoBridgesAreToldApartByTheirSerialNumbers) {
  plug_in("FT0001");
  Ft232h other("FT0002", 1, 8);
  ASSERT_TRUE(until_true(20s, [] { return std::filesystem::exists("/dev/ttyUSB1"); }));
  const auto any = open_plugin({});
  ASSERT_FALSE(any);
  EXPECT_NE(any.error().message.find("FT0001"), std::string::npos) << any.error().message;
  EXPECT_NE(any.error().message.find("FT0002"), std::string::npos) << any.error().message;
  for (Ft232h* const chosen : {&*sensor_, &other}) {
    received_ = {};
    const std::string& serial = chosen->bridge.identity().serial;
    open({{"serial", serial}});
    EXPECT_EQ(device_->info().serial, serial);
    ASSERT_EQ(read(400), ReadOutcome::kSamples);
    EXPECT_EQ(holes(chosen->taken()), received_[kImu].flagged(IMUNOISE_SAMPLE_AFTER_GAP));
    device_.reset();
  }
}

TEST_F(UsbOfTheKernel, ACp2130) {
  Cp2130 sensor("CP0042", 0, 7);
  ASSERT_TRUE(until_true(20s, [] { return open_plugin({}).has_value(); }));
  open({{"bridge", "cp2130"}, {"rate", "102.4"}});
  EXPECT_EQ(device_->info().serial, "CP0042");
  ASSERT_EQ(read(500), ReadOutcome::kSamples);
  const std::size_t gaps = received_[kImu].flagged(IMUNOISE_SAMPLE_AFTER_GAP);
  EXPECT_EQ(holes(sensor.taken()), gaps);
  sensor.usb.unplug();
  ASSERT_EQ(read(100'000), ReadOutcome::kDisconnected);
  sensor.usb.plug();
  ASSERT_TRUE(until_true(30s, [&] { return read(100) == ReadOutcome::kSamples; }));
  EXPECT_EQ(received_[kImu].flagged(IMUNOISE_SAMPLE_AFTER_RESTART), 2U);
  device_.reset();
}

}  // namespace
}  // namespace imunoise::testing
