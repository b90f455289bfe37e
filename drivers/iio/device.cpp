#include "drivers/iio/device.h"

#include <chrono>
#include <utility>

namespace imunoise::iio {
namespace {

constexpr std::chrono::milliseconds kRetry{200};

}  // namespace

IioDevice::IioDevice(Choice choice, const plugin::Host& host)
    : choice_(std::move(choice)), host_(host), device_(std::in_place, choice_) {
  drivers::Stream stream{"imu", {}, device_->rate_hz()};
  for (const ScanChannel& channel : device_->channels()) {
    stream.channels.push_back(describe_channel(channel));
  }
  info_.streams = {std::move(stream)};
  info_.product = device_->name();
}

drivers::DeviceInfo IioDevice::describe() { return info_; }

bool IioDevice::reopen(const plugin::Wait& wait) {
  do {
    try {
      device_.emplace(choice_);
      if (device_->channels().size() != info_.streams.front().channels.size()) {
        throw plugin::DeviceError(IMUNOISE_BAD_DEVICE,
                                  info_.product + ": came back with other channels");
      }
      next_flags_ = IMUNOISE_SAMPLE_AFTER_RESTART;
      host_.note(info_.product + ": is back");
      return true;
    } catch (const plugin::DeviceError& error) {
      device_.reset();
      if (error.code() != IMUNOISE_NOT_FOUND && error.code() != IMUNOISE_NO_ACCESS) throw;
    }
  } while (wait.until(plugin::Wait::Clock::now() + kRetry));
  return false;
}

void IioDevice::read(plugin::Samples& samples, const plugin::Wait& wait) {
  if (!device_ && !reopen(wait)) return;
  if (!wait.ready(device_->descriptor())) return;
  time_.look(host_);
  try {
    for (const Scan& scan : device_->take()) {
      const std::uint32_t flags = std::exchange(next_flags_, 0);
      plugin::Row row = samples.add(0, {time_.host_time_ns(scan.time_ns), 0, 0, flags});
      for (std::size_t i = 0; i < scan.numbers.size(); ++i) row.set(i, scan.numbers[i]);
    }
  } catch (const plugin::DeviceError&) {
    device_.reset();
    throw;
  }
}

}  // namespace imunoise::iio
