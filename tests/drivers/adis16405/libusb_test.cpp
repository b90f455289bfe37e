// The plugin as it is shipped, with the real libusb, against an emulated device under /dev/bus/usb.

#include <gtest/gtest.h>

#include <optional>
#include <thread>

#include "drivers/emulator/usb/cp2130.h"
#include "drivers/emulator/usb/ft232h.h"
#include "tests/drivers/adis16405/installed_plugin.h"
#include "tests/drivers/adis16405/usbfs.h"

namespace imunoise::testing {
namespace {

using namespace std::chrono_literals;
using drivers::ReadOutcome;

class Libusb : public ::testing::Test {
 protected:
  Libusb()
      : source_({}, {{1.0, 1.0, 1.0}, {9.0, 9.0, 9.0}, {1e-4, 1e-4, 1e-4}, 9.0, 1.0, 1.0}, 7) {}

  void SetUp() override {
    if (!UsbFs::available()) GTEST_SKIP() << "run it by ctest, or under umockdev-wrapper";
    usb_.emplace(bridge_);
  }

  std::vector<Counts> taken() {
    const auto held = usb_->lock();
    return imu_counts(sensor_);
  }

  emulator::GaussianSource source_;
  emulator::Adis16405 sensor_{source_, 7};
  emulator::Ft232h bridge_{sensor_, "FT0042"};
  std::optional<UsbFs> usb_;
};

TEST_F(Libusb, EverySampleAsItWasTaken) {
  const auto device = open_plugin({});
  ASSERT_TRUE(device) << device.error().message;
  EXPECT_EQ((*device)->info().serial, "FT0042");
  std::array<Received, 3> received;
  ASSERT_EQ(read_imu(**device, 400, received), ReadOutcome::kSamples);
  expect_stretch(received[kImu].rows, taken());
  EXPECT_EQ(received[kImu].flagged(~0U), 1U);
}

TEST_F(Libusb, UnpluggedAndPluggedIn) {
  const auto device = open_plugin({});
  ASSERT_TRUE(device) << device.error().message;
  std::array<Received, 3> received;
  ASSERT_EQ(read_imu(**device, 50, received), ReadOutcome::kSamples);
  usb_->unplug();
  ASSERT_EQ(read_imu(**device, 100'000, received), ReadOutcome::kDisconnected);
  EXPECT_NE((*device)->disconnection().find("FT0042"), std::string::npos)
      << (*device)->disconnection();
  drivers::SampleBlock block = (*device)->make_block(10);
  EXPECT_EQ(*(*device)->read(300ms, block), ReadOutcome::kDisconnected);
  const std::size_t before = received[kImu].rows.size();
  usb_->plug();
  ASSERT_EQ(read_imu(**device, before + 100, received), ReadOutcome::kSamples);
  EXPECT_LE(expect_in_order(received[kImu].rows, taken()), 1U);
  EXPECT_EQ(received[kImu].flagged(IMUNOISE_SAMPLE_AFTER_RESTART), 2U);
}

// Endpoints stay halted until the host clears them, also over a new opening.
TEST_F(Libusb, AHaltedEndpointIsCleared) {
  const auto device = open_plugin({});
  ASSERT_TRUE(device) << device.error().message;
  std::array<Received, 3> received;
  ASSERT_EQ(read_imu(**device, 50, received), ReadOutcome::kSamples);
  usb_->halt_in();
  ASSERT_EQ(read_imu(**device, 100'000, received), ReadOutcome::kDisconnected);
  EXPECT_NE((*device)->disconnection().find("refuses a transfer"), std::string::npos)
      << (*device)->disconnection();
  const std::size_t before = received[kImu].rows.size();
  ASSERT_EQ(read_imu(**device, before + 100, received), ReadOutcome::kSamples);
  EXPECT_EQ(received[kImu].flagged(IMUNOISE_SAMPLE_AFTER_RESTART), 2U);
}

TEST_F(Libusb, InUseByAnotherProgram) {
  usb_->set_busy(true);
  const auto device = open_plugin({});
  ASSERT_FALSE(device);
  EXPECT_NE(device.error().message.find("another program uses it"), std::string::npos)
      << device.error().message;
}

TEST_F(Libusb, NotPluggedIn) {
  usb_->unplug();
  const auto device = open_plugin({{"bridge", "ft232h"}});
  ASSERT_FALSE(device);
  EXPECT_NE(device.error().message.find("no USB-SPI bridge"), std::string::npos)
      << device.error().message;
}

TEST_F(Libusb, OptionsAreChecked) {
  EXPECT_NE(open_plugin({{"rate", "100"}}).error().message.find("102.4"), std::string::npos);
  EXPECT_NE(open_plugin({{"gyro_range", "75"}}).error().message.find("at least 4"),
            std::string::npos);
}

TEST_F(Libusb, CancelEndsAWait) {
  const auto device = open_plugin({});
  ASSERT_TRUE(device) << device.error().message;
  {
    const auto held = usb_->lock();
    sensor_.faults.stalled = true;
  }
  (*device)->cancel();
  drivers::SampleBlock block = (*device)->make_block(10);
  EXPECT_EQ(*(*device)->read(1h, block), ReadOutcome::kCancelled);
}

class LibusbCp2130 : public Libusb {
 protected:
  void SetUp() override {
    if (!UsbFs::available()) GTEST_SKIP() << "run it by ctest, or under umockdev-wrapper";
    usb_.emplace(cp2130_);
  }

  emulator::Cp2130 cp2130_{sensor_, "CP0042"};
};

TEST_F(LibusbCp2130, EverySampleAsItWasTaken) {
  const auto device = open_plugin({});
  ASSERT_TRUE(device) << device.error().message;
  EXPECT_EQ((*device)->info().serial, "CP0042");
  std::array<Received, 3> received;
  ASSERT_EQ(read_imu(**device, 200, received), ReadOutcome::kSamples);
  expect_stretch(received[kImu].rows, taken());
}

// A reader that the machine keeps waiting: the emulated device waits with it.
TEST_F(LibusbCp2130, ABusyMachineLosesNothing) {
  const auto device = open_plugin({});
  ASSERT_TRUE(device) << device.error().message;
  std::array<Received, 3> received;
  for (std::size_t samples = 1; samples < 200; samples += 10) {
    ASSERT_EQ(read_imu(**device, samples, received), ReadOutcome::kSamples);
    std::this_thread::sleep_for(50ms);
  }
  expect_stretch(received[kImu].rows, taken());
}

}  // namespace
}  // namespace imunoise::testing
