// kill -9 of a process that records, at random moments: what it was told to be safe is in a chunk
// after the recovery, once.

#include <gtest/gtest.h>

#include <chrono>
#include <cstdint>
#include <random>
#include <thread>

#include "core/support/parallel.h"
#include "tests/recording/files.h"
#include "tests/recording/store/endless_recording.h"

namespace imunoise::recording {
namespace {

class Kill : public FileTest {
 protected:
  void once(std::uint64_t seed, std::chrono::microseconds delay) {
    SCOPED_TRACE("seed " + std::to_string(seed) + ", killed after " +
                 std::to_string(delay.count()) + " us");
    const auto root = path("run" + std::to_string(seed));
    EndlessRecording recording(root);
    std::this_thread::sleep_for(delay);
    const std::uint64_t safe = recording.kill();
    told_ += safe;
    expect_recovered(root, safe);
  }

  std::uint64_t told_ = 0;  // blocks acknowledged in all runs
};

TEST_F(Kill, AtRandomMoments) {
  const ThreadLimit single(1);  // no thread but ours when it forks
  for (std::uint64_t seed = 1; seed <= IMUNOISE_KILLS; ++seed) {
    std::mt19937_64 random(seed);
    once(seed, std::chrono::microseconds(random() % 150'000));
    if (HasFailure()) return;
  }
  EXPECT_GT(told_, 0U) << "no run got as far as an acknowledged block";
}

}  // namespace
}  // namespace imunoise::recording
