// A driver that breaks the rules of driver.h is named and left alone.

#include "drivers/host/device.h"

#include <gtest/gtest.h>

#include "drivers/host/load.h"

namespace imunoise::drivers {
namespace {

using namespace std::chrono_literals;

Result<std::unique_ptr<Device>> open_faulty(const char* fault) {
  static const Drivers kDrivers =
      load_drivers({std::filesystem::path(IMUNOISE_TEST_PLUGINS) / "faulty"});
  const OptionText option = {"fault", fault};
  return Device::open(**kDrivers.find("faulty"), std::span(&option, 1));
}

struct Fault {
  const char* name;
  const char* complaint;  // part of it
};

void PrintTo(const Fault& fault, std::ostream* out) { *out << fault.name; }

class FaultyOpen : public ::testing::TestWithParam<Fault> {};

TEST_P(FaultyOpen, IsAnError) {
  const auto device = open_faulty(GetParam().name);
  ASSERT_FALSE(device);
  EXPECT_NE(device.error().message.find(std::string("driver faulty: ") + GetParam().complaint),
            std::string::npos)
      << device.error().message;
}

INSTANTIATE_TEST_SUITE_P(All, FaultyOpen,
                         ::testing::Values(Fault{"throw_in_open", "the driver threw an exception"},
                                           Fault{"endless_error", "eeee"},
                                           Fault{"latin1_error", "no sensor at 20 \xEF\xBF\xBD C"},
                                           Fault{"no_handle", "open succeeded without a device"},
                                           Fault{"no_info", "describes the device by NULL"},
                                           Fault{"no_streams", "the device: has no streams"}));

class FaultyRead : public ::testing::TestWithParam<Fault> {};

TEST_P(FaultyRead, IsAnErrorForEver) {
  const auto device = open_faulty(GetParam().name);
  ASSERT_TRUE(device) << device.error().message;
  SampleBlock block = (*device)->make_block(4);
  const auto outcome = (*device)->read(0ms, block);
  ASSERT_FALSE(outcome);
  EXPECT_NE(outcome.error().message.find(GetParam().complaint), std::string::npos)
      << outcome.error().message;
  EXPECT_NE(outcome.error().message.find("imunoise-faulty.so"), std::string::npos);
  EXPECT_EQ(block.rows(), 0U);
  const auto again = (*device)->read(0ms, block);
  ASSERT_FALSE(again);
  EXPECT_EQ(again.error().message, outcome.error().message);
}

INSTANTIATE_TEST_SUITE_P(
    All, FaultyRead,
    ::testing::Values(Fault{"too_many_rows", "read delivered 5 samples of stream only where 4 fit"},
                      Fault{"unknown_stream", "read delivered stream 1 of 1"},
                      Fault{"nan_number", "stream only: channel x: a number is not finite"},
                      Fault{"counter_beyond", "counter 256 is beyond its maximum 255"},
                      Fault{"nothing_at_all", "without samples, rejections"},
                      Fault{"samples_with_timeout", "read delivered samples and returned 1"},
                      Fault{"throw_in_read", "read threw an exception"},
                      Fault{"unknown_status", "read returned 99, which is not a valid status"}));

TEST(FaultyDevice, ReadsAsLongAsItKeepsTheRules) {
  const auto device = open_faulty("none");
  ASSERT_TRUE(device) << device.error().message;
  SampleBlock block = (*device)->make_block(4);
  const auto outcome = (*device)->read(0ms, block);
  ASSERT_TRUE(outcome) << outcome.error().message;
  EXPECT_EQ(*outcome, ReadOutcome::kSamples);
  EXPECT_EQ(block.rows(), 1U);
  EXPECT_EQ(block.counter()[0], 255U);
  EXPECT_EQ(block.column<double>(0)[0], 1.0);
}

TEST(FaultyDevice, MayFailWithoutAWordOrBeGoneForAWhile) {
  const auto failing = open_faulty("unknown_error");
  SampleBlock block = (*failing)->make_block(1);
  EXPECT_EQ((*failing)->read(0ms, block).error().message, "driver faulty: unknown error");
  const auto gone = open_faulty("gone");
  SampleBlock other = (*gone)->make_block(1);
  for (int i = 0; i < 2; ++i) {
    const auto outcome = (*gone)->read(0ms, other);
    ASSERT_TRUE(outcome) << outcome.error().message;
    EXPECT_EQ(*outcome, ReadOutcome::kDisconnected);
    EXPECT_EQ((*gone)->disconnection(), "driver faulty: the cable was pulled");
  }
}

}  // namespace
}  // namespace imunoise::drivers
