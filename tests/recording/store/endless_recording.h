#pragma once

// A process that records until it is killed, and the check of what it left.

#include <sys/types.h>

#include <atomic>
#include <cstdint>
#include <filesystem>
#include <thread>

namespace imunoise::recording {

/// Records for ever in a child process, which tells the number of the last block that is safe. No
/// other thread may run when it starts.
class EndlessRecording {
 public:
  explicit EndlessRecording(const std::filesystem::path& root);
  EndlessRecording(const EndlessRecording&) = delete;
  EndlessRecording& operator=(const EndlessRecording&) = delete;
  ~EndlessRecording();

  /// Blocks that the recorder has acknowledged so far.
  std::uint64_t safe() const { return safe_; }
  /// kill -9. A child that has ended by itself is a failure of the test. Returns safe().
  std::uint64_t kill();

 private:
  pid_t child_ = 0;
  int pipe_ = -1;
  std::atomic<std::uint64_t> safe_ = 0;
  std::thread reader_;
};

/// After a repair the recording is sound and holds the blocks that were acknowledged, each once.
void expect_recovered(const std::filesystem::path& root, std::uint64_t safe_blocks);

}  // namespace imunoise::recording
