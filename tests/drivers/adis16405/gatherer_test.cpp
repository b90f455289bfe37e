// Samples from torn bursts.

#include "drivers/adis16405/gatherer.h"

#include <gtest/gtest.h>

namespace imunoise::drivers::adis16405 {
namespace {

// A burst whose words are all `number`, new where `is_new` says.
Burst burst(std::int16_t number, unsigned is_new) {
  Burst out;
  out.counts.fill(number);
  out.is_new = static_cast<std::uint16_t>(is_new);
  return out;
}

TEST(Gatherer, TakesAWholeBurst) {
  Gatherer gatherer(kInertialChannels);
  ASSERT_EQ(gatherer.take(burst(5, kInertialChannels)), Gathered::kSample);
  EXPECT_EQ(gatherer.sample().counts[1], 5);
  EXPECT_EQ(gatherer.take(burst(5, kMagneticChannels)), Gathered::kNothingNew);
}

TEST(Gatherer, JoinsTheTwoPartsOfASample) {
  Gatherer gatherer(kInertialChannels);
  EXPECT_EQ(gatherer.take(burst(1, 0x0078)), Gathered::kPart);  // gyro_z and the accelerometers
  ASSERT_EQ(gatherer.take(burst(2, 0x0006)), Gathered::kSample);
  EXPECT_EQ(gatherer.sample().counts[1], 2);
  EXPECT_EQ(gatherer.sample().counts[2], 2);
  EXPECT_EQ(gatherer.sample().counts[3], 1);
  EXPECT_EQ(gatherer.sample().counts[6], 1);
  EXPECT_EQ(gatherer.take_lost(), 0U);
  EXPECT_EQ(gatherer.take(burst(3, 0x0078)), Gathered::kPart) << "no word is used twice";
}

TEST(Gatherer, JoinsWhateverStandsBetween) {
  Gatherer gatherer(kSlowChannels);
  EXPECT_EQ(gatherer.take(burst(1, 0x0c00)), Gathered::kPart);  // temperature, auxiliary input
  EXPECT_EQ(gatherer.take(burst(9, 0x0000)), Gathered::kNothingNew);
  ASSERT_EQ(gatherer.take(burst(2, 0x0001)), Gathered::kSample);
  EXPECT_EQ(gatherer.sample().counts[0], 2);
  EXPECT_EQ(gatherer.sample().counts[11], 1);
}

TEST(Gatherer, GivesUpPartsThatDoNotFit) {
  Gatherer gatherer(kInertialChannels);
  EXPECT_EQ(gatherer.take(burst(1, 0x0078)), Gathered::kPart);
  EXPECT_EQ(gatherer.take(burst(2, 0x0002)), Gathered::kPart);  // gyro_y never came
  EXPECT_EQ(gatherer.take_lost(), 1U);
  EXPECT_EQ(gatherer.take(burst(3, kInertialChannels)), Gathered::kSample);
  EXPECT_EQ(gatherer.take_lost(), 1U);
  EXPECT_EQ(gatherer.take_lost(), 0U);
  // The first words, and then the last ones, are of two samples.
  EXPECT_EQ(gatherer.take(burst(4, 0x0006)), Gathered::kPart);
  EXPECT_EQ(gatherer.take(burst(5, 0x0078)), Gathered::kPart);
  // A hole in the middle is no part of a torn sample.
  EXPECT_EQ(gatherer.take(burst(6, 0x0066)), Gathered::kPart);
  EXPECT_EQ(gatherer.take(burst(7, 0x0018)), Gathered::kPart);
  EXPECT_EQ(gatherer.take_lost(), 3U);
}

TEST(Gatherer, KeepsAnAlarmOfEitherPart) {
  Gatherer gatherer(kInertialChannels);
  Burst first = burst(1, 0x0078);
  first.alarm = 0x0fff;
  gatherer.take(first);
  ASSERT_EQ(gatherer.take(burst(2, 0x0006)), Gathered::kSample);
  EXPECT_NE(gatherer.sample().alarm, 0);
}

}  // namespace
}  // namespace imunoise::drivers::adis16405
