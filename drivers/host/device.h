#pragma once

// An open device, as the rest of the program sees it.

#include <chrono>
#include <cstddef>
#include <memory>
#include <optional>
#include <span>
#include <stop_token>
#include <string>
#include <string_view>

#include "core/support/result.h"
#include "drivers/host/block.h"
#include "drivers/host/driver.h"
#include "drivers/host/handlers.h"
#include "drivers/host/option_values.h"
#include "drivers/host/services.h"

namespace imunoise::drivers {

/// What a read came to.
enum class ReadOutcome {
  kSamples,       ///< The block holds samples, or counts of refused ones.
  kTimeout,       ///< Nothing came in time.
  kCancelled,     ///< cancel() was called; so will every later read say.
  kEnd,           ///< Nothing will ever come again.
  kDisconnected,  ///< The device is gone; the driver looks for it when read() is called again.
};

/// One thread at a time calls it, except for cancel().
class Device {
 public:
  /// Finds and starts the device that the options name; may take seconds, but not once `stop` asks
  /// for an end (unless the driver does not listen to it). Errors: an option that the driver has
  /// not or does not allow, what the driver says, a description that makes no sense, the end.
  static Result<std::unique_ptr<Device>> open(const Driver& driver,
                                              std::span<const OptionText> options = {},
                                              NoteHandler note = {}, WireHandler wire = {},
                                              std::stop_token stop = {});
  Device(const Device&) = delete;
  Device& operator=(const Device&) = delete;
  /// Stops the device. No read or cancel may be running.
  ~Device();

  const DeviceInfo& info() const { return *info_; }
  /// A block that fits this device, for `rows` samples (at least 1) of a stream. May outlive it.
  SampleBlock make_block(std::size_t rows) const { return {info_, rows}; }

  /// Waits at most `timeout` (0: does not wait) for samples of one stream. Errors: the device's
  /// failure, after which it can only be closed; and whatever the driver does against driver.h
  /// (more rows than fit, a counter beyond its maximum, a number that is not finite, an exception):
  /// after that the driver is not called again.
  Result<ReadOutcome> read(std::chrono::milliseconds timeout, SampleBlock& block);
  /// Why the last read that said kDisconnected did so.
  const std::string& disconnection() const { return disconnection_; }

  /// Ends a read that waits, and all later ones. From any thread. Returns at once.
  void cancel() noexcept;

 private:
  Device(Driver driver, NoteHandler note, WireHandler wire, std::stop_token stop);
  Result<void> start(const OptionValues& values);
  Result<ReadOutcome> outcome(std::int32_t status, const SampleBlock& block, std::string_view text);
  Result<void> check_samples(const SampleBlock& block) const;

  Driver driver_;
  DeviceHandlers handlers_;
  imunoise_device* handle_ = nullptr;
  std::shared_ptr<const DeviceInfo> info_;
  std::string disconnection_;
  std::optional<Error> broken_;  // what the driver did against driver.h
};

}  // namespace imunoise::drivers
