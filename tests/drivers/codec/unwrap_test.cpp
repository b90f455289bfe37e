#include "drivers/codec/unwrap.h"

#include <gtest/gtest.h>

#include <random>

namespace imunoise::drivers {
namespace {

TEST(Unwrapper, FollowsACounterThroughManyWraps) {
  constexpr std::uint64_t kSeed = 11;
  SCOPED_TRACE(kSeed);
  std::mt19937_64 random(kSeed);
  for (const std::int64_t modulus : {5, 256, 65536, 864'000'000}) {
    Unwrapper unwrap(modulus);
    // Steps of less than half the modulus, backwards too, are exact.
    std::int64_t truth = modulus / 2;
    std::uniform_int_distribution<std::int64_t> step(-(modulus - 1) / 2 / 2, (modulus - 1) / 2);
    ASSERT_EQ(unwrap(truth), truth);
    for (int i = 0; i < 1000; ++i) {
      truth += step(random);
      const std::int64_t raw = (truth % modulus + modulus) % modulus;
      ASSERT_EQ(unwrap(raw), truth) << "modulus " << modulus << " step " << i;
    }
  }
}

TEST(Unwrapper, WidensWithoutAJump) {
  Unwrapper unwrap(100);
  EXPECT_EQ(unwrap(90), 90);
  unwrap.widen(1000);
  EXPECT_EQ(unwrap(110), 110);
  EXPECT_EQ(unwrap(5), 5);  // 105 back is nearer than 895 on
}

}  // namespace
}  // namespace imunoise::drivers
