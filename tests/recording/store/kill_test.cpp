// kill -9 of a process that records, at random moments: what it was told to be safe is in a chunk
// after the recovery, once.

#include <gtest/gtest.h>

#include <chrono>
#include <cstdint>
#include <iostream>
#include <random>
#include <thread>

#include "core/support/parallel.h"
#include "tests/recording/files.h"
#include "tests/recording/store/endless_recording.h"

namespace imunoise::recording {
namespace {

using std::chrono::microseconds;

constexpr std::uint64_t kFullLength = 300;  // blocks: some ten segments
constexpr auto kLongest = std::chrono::minutes(5);

// Records until `enough` says so of the time since the start and of the blocks that are safe; then
// kills it and checks what is there.
class Kill : public FileTest {
 protected:
  template <typename Enough>
  microseconds record_until(const std::string& name, const Enough& enough) {
    const auto root = path(name);
    const auto begin = std::chrono::steady_clock::now();
    EndlessRecording recording(root);
    const auto elapsed = [begin] {
      return std::chrono::duration_cast<microseconds>(std::chrono::steady_clock::now() - begin);
    };
    while (!enough(elapsed(), recording.safe())) std::this_thread::sleep_for(microseconds(100));
    const microseconds out = elapsed();
    expect_recovered(root, recording.kill());
    return out;
  }
};

TEST_F(Kill, AtRandomMoments) {
  const ThreadLimit single(1);  // no thread but ours when it forks
  // How long it takes depends on the machine, and on what else runs there.
  const microseconds full = record_until("full", [](microseconds elapsed, std::uint64_t safe) {
    return safe >= kFullLength || elapsed > kLongest;
  });
  ASSERT_LE(full, kLongest) << "its blocks were not acknowledged";
  std::cout << "all blocks safe after " << full.count() << " us\n";
  for (std::uint64_t seed = 1; seed <= IMUNOISE_KILLS && !HasFailure(); ++seed) {
    std::mt19937_64 random(seed);
    const microseconds moment(random() % static_cast<std::uint64_t>(full.count()));
    SCOPED_TRACE("seed " + std::to_string(seed) + ", killed after " +
                 std::to_string(moment.count()) + " us");
    record_until("run" + std::to_string(seed),
                 [moment](microseconds elapsed, std::uint64_t) { return elapsed >= moment; });
  }
}

}  // namespace
}  // namespace imunoise::recording
