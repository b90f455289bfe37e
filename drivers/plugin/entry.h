#pragma once

// From the C table of driver.h to a Device and back; exceptions end here.

#include <algorithm>
#include <cstring>
#include <exception>
#include <memory>
#include <string_view>
#include <utility>

#include "drivers/plugin/description_tables.h"
#include "drivers/plugin/device.h"
#include "drivers/plugin/options.h"

namespace imunoise::plugin {

/// Makes a device of the user's options; throws DeviceError.
using OpenFunction = std::unique_ptr<Device> (*)(const Options& options, const Host& host);

/// Writes `text` into the host's buffer, cut off where it is full. Returns `code`.
inline std::int32_t report(imunoise_error* error, std::int32_t code, std::string_view text) {
  if (error != nullptr && error->capacity > 0) {
    const std::size_t length = std::min<std::size_t>(text.size(), error->capacity - 1);
    std::memcpy(error->text, text.data(), length);
    error->text[length] = '\0';
  }
  return code;
}

/// Runs one operation; what it throws becomes code and text.
template <class Operation>
std::int32_t at_the_edge(imunoise_error* error, Operation&& operation) noexcept {
  try {
    return operation();
  } catch (const DeviceError& failure) {
    return report(error, failure.code(), failure.what());
  } catch (const std::exception& failure) {
    return report(error, IMUNOISE_FAILED, failure.what());
  } catch (...) {
    return report(error, IMUNOISE_FAILED,
                  "the driver threw an object that is not a std::exception");
  }
}

/// A Device with what the base keeps for it: its description, its samples, its cancel.
class OpenDevice {
 public:
  explicit OpenDevice(std::unique_ptr<Device> device)
      : device_(std::move(device)),
        info_(device_->describe()),
        tables_(info_.streams),
        table_{sizeof(imunoise_device_info), tables_.size(),       tables_.data(),
               info_.product.c_str(),        info_.serial.c_str(), info_.firmware.c_str()},
        samples_(info_.streams) {}

  const imunoise_device_info* table() const { return &table_; }

  std::int32_t read(std::chrono::milliseconds timeout, imunoise_block& block) {
    const Wait wait(cancelled_, timeout);
    // The device is asked at least once, also where the host does not wait.
    for (bool asked = false;; asked = true) {
      if (wait.cancelled()) return IMUNOISE_CANCELLED;
      if (samples_.deliver(block)) return IMUNOISE_OK;
      if (failure_) std::rethrow_exception(std::exchange(failure_, nullptr));
      if (samples_.ended()) return IMUNOISE_END;
      if (asked && wait.over()) return wait.cancelled() ? IMUNOISE_CANCELLED : IMUNOISE_TIMEOUT;
      ask(wait);
    }
  }

  void cancel() noexcept {
    cancelled_.set();
    device_->interrupt();
  }

 private:
  void ask(const Wait& wait) {
    try {
      device_->read(samples_, wait);
    } catch (...) {
      failure_ = std::current_exception();  // told when what came before it is delivered
    }
  }

  std::unique_ptr<Device> device_;
  drivers::DeviceInfo info_;
  StreamTables tables_;
  imunoise_device_info table_;
  Samples samples_;
  CancelSignal cancelled_;
  std::exception_ptr failure_;
};

/// The C operations. The handle is an OpenDevice.
struct Operations {
  static OpenDevice& device(imunoise_device* handle) {
    return *static_cast<OpenDevice*>(static_cast<void*>(handle));
  }
  static std::int32_t open(OpenFunction function, const imunoise_host* table, void* context,
                           const imunoise_option_value* const* values, std::uint32_t count,
                           imunoise_device** handle, imunoise_error* error) noexcept {
    return at_the_edge(error, [&] {
      const Host host(table, context);
      const Opening opening(host);
      auto device = std::make_unique<OpenDevice>(function(Options(values, count), host));
      *handle = static_cast<imunoise_device*>(static_cast<void*>(device.release()));
      return IMUNOISE_OK;
    });
  }
  static std::int32_t describe(imunoise_device* handle, const imunoise_device_info** info,
                               imunoise_error* /*error*/) noexcept {
    *info = device(handle).table();
    return IMUNOISE_OK;
  }
  static std::int32_t read(imunoise_device* handle, std::int32_t timeout_ms, imunoise_block* block,
                           imunoise_error* error) noexcept {
    return at_the_edge(
        error, [&] { return device(handle).read(std::chrono::milliseconds(timeout_ms), *block); });
  }
  static void cancel(imunoise_device* handle) noexcept { device(handle).cancel(); }
  static void close(imunoise_device* handle) noexcept { delete &device(handle); }
};

/// A driver's table with the description it points into. Lives for ever, where it is.
class Driver {
 public:
  using Open = decltype(imunoise_driver::open);

  Driver(drivers::DriverInfo info, Open open)
      : info_(std::move(info)),
        options_(info_.options),
        streams_(info_.streams),
        table_{sizeof(imunoise_driver), IMUNOISE_DRIVER_ABI,
               info_.name.c_str(),      info_.description.c_str(),
               info_.version.c_str(),   options_.size(),
               streams_.size(),         options_.data(),
               streams_.data(),         open,
               &Operations::describe,   &Operations::read,
               &Operations::cancel,     &Operations::close} {}
  Driver(const Driver&) = delete;
  Driver& operator=(const Driver&) = delete;

  const imunoise_driver* table() const { return &table_; }

 private:
  drivers::DriverInfo info_;
  OptionTables options_;
  StreamTables streams_;
  imunoise_driver table_;
};

}  // namespace imunoise::plugin
