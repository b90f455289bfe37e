#pragma once

// Reads one device into a recording, from a thread of its own.

#include <atomic>
#include <chrono>
#include <condition_variable>
#include <functional>
#include <memory>
#include <mutex>
#include <optional>
#include <stop_token>
#include <string>
#include <thread>
#include <vector>

#include "daemon/acquire/stillness.h"
#include "daemon/acquire/stream_clocks.h"
#include "drivers/host/device.h"
#include "recording/store/disk/back_off.h"
#include "recording/store/recorder/recorder.h"

namespace imunoise::acquire {

/// A device that failed is opened again: after `first`, then after twice as long each time, up to
/// `longest`.
struct Reopening {
  std::chrono::milliseconds first{1000};
  std::chrono::milliseconds longest{30000};
};

/// Where a reader's samples come from and go to.
struct ReaderPlan {
  std::size_t index = 0;  ///< Of the device in the recording.
  v1::RecordedDevice device;
  std::string driver;
  /// Opens the device once more; without it a failure ends the reader.
  std::function<Result<std::unique_ptr<drivers::Device>>(const std::stop_token&)> open;
  Reopening reopening;
  /// Sees what is recorded; may be empty.
  std::function<void(const recording::Block&)> observe;
  std::int64_t shift_ns = 0;  ///< From the host's clock to the recording's time stamps.
  /// How long the device is not read because the disk leaves no room. Then it is read on, and what
  /// finds no room is counted, until the disk takes something again.
  std::chrono::milliseconds disk_patience{10000};
};

/// Its thread is the only one that reads the device.
class Reader {
 public:
  Reader(recording::Recorder& recorder, ReaderPlan plan, std::unique_ptr<drivers::Device> device);
  ~Reader() { stop(); }
  Reader(const Reader&) = delete;
  Reader& operator=(const Reader&) = delete;

  /// From any thread; returns at once.
  void request_stop();
  /// The same, and waits for the reader's end: for the driver's answer to cancel(), or to the end
  /// of an attempt to open it.
  void stop();
  /// Nothing will come any more.
  bool ended() const { return ended_; }

  // After stop().
  std::uint64_t disconnections() const { return disconnections_; }
  /// Why nothing comes from the device: its failure, or why it was gone last.
  const std::optional<Error>& failure() const { return failure_; }
  /// Rows that were not recorded because the disk left no room for them, and what it said last.
  std::uint64_t discarded() const { return discarded_; }
  const std::string& disk_failure() const { return disk_failure_; }
  /// When the last samples came.
  std::optional<std::chrono::steady_clock::time_point> last() const { return last_; }
  /// It was there to the end, or had nothing more to say.
  bool connected() const { return connected_; }
  const std::string& disconnection() const { return disconnection_; }
  std::vector<v1::Disturbance> disturbances() const { return stillness_.disturbances(); }
  std::vector<v1::ClockComparison> clocks() const;

 private:
  void run();
  bool step(drivers::SampleBlock& block);
  bool push(const drivers::SampleBlock& block);
  bool deliver(const recording::Block& block);
  Result<bool> push_patiently(const recording::Block& block);
  bool open_again();
  Result<std::unique_ptr<drivers::Device>> same_device() const;

  recording::Recorder& recorder_;
  ReaderPlan plan_;
  StillnessWatch stillness_;
  StreamClocks clocks_;
  std::vector<bool> lost_;           // of each stream: samples are missing before its next row
  std::chrono::milliseconds pause_;  // before it is opened the next time
  bool connected_ = true;
  std::uint64_t disconnections_ = 0;
  std::string disconnection_;
  std::optional<Error> failure_;
  std::optional<std::chrono::steady_clock::time_point> last_;
  std::uint64_t discarded_ = 0;
  std::string disk_failure_;
  std::chrono::milliseconds disk_patience_;
  recording::BackOff disk_pause_;
  std::chrono::steady_clock::time_point disk_next_ = {};
  std::atomic<bool> ended_ = false;

  std::mutex mutex_;  // guards what follows
  std::condition_variable stopping_;
  std::stop_source stop_;
  std::unique_ptr<drivers::Device> device_;

  std::thread thread_;  // last: it uses all of the above
};

}  // namespace imunoise::acquire
