#pragma once

// A device that did not answer in time, and may still come.

#include <condition_variable>
#include <functional>
#include <memory>
#include <mutex>
#include <stop_token>
#include <thread>

#include "daemon/acquire/reader.h"
#include "drivers/host/device.h"

namespace imunoise::acquire {

/// Opens it again and again, on a thread of its own, until it comes or is no longer awaited.
class Latecomer {
 public:
  using Open = std::function<Result<std::unique_ptr<drivers::Device>>(const std::stop_token&)>;

  Latecomer(Open open, const Reopening& pauses);
  Latecomer(const Latecomer&) = delete;
  Latecomer& operator=(const Latecomer&) = delete;

  /// The replicate ends; returns at once.
  void request_stop() { thread_.request_stop(); }
  /// Hands it over once it has come; null before and after that. From any thread.
  std::unique_ptr<drivers::Device> take();

 private:
  void run(const std::stop_token& stop);

  const Open open_;
  const Reopening pauses_;
  std::mutex mutex_;
  std::condition_variable_any stopping_;
  std::unique_ptr<drivers::Device> device_;  // guarded by the mutex
  std::jthread thread_;                      // last: it uses all of the above
};

}  // namespace imunoise::acquire
