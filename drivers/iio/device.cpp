#include "drivers/iio/device.h"

#include <chrono>
#include <utility>
#include <vector>

namespace imunoise::iio {
namespace {

constexpr std::chrono::milliseconds kRetry{200};

std::vector<drivers::Channel> channels_of(const BufferedDevice& device) {
  std::vector<drivers::Channel> out;
  for (const ScanChannel& channel : device.channels()) out.push_back(describe_channel(channel));
  return out;
}

}  // namespace

IioDevice::IioDevice(Choice choice, const plugin::Host& host)
    : choice_(std::move(choice)), host_(host), device_(std::in_place, choice_) {
  info_.streams = {{"imu", channels_of(*device_), device_->rate_hz()}};
  info_.product = device_->name();
  choice_.device = device_->lasting_name();
  if (device_->rate_hz() > 0.0) choice_.rate_hz = device_->rate_hz();  // it returns with another
}

drivers::DeviceInfo IioDevice::describe() { return info_; }

bool IioDevice::reopen(const plugin::Wait& wait) {
  do {
    try {
      device_.emplace(choice_);
      if (channels_of(*device_) != info_.streams.front().channels) {
        throw plugin::DeviceError(
            IMUNOISE_BAD_DEVICE,
            info_.product + ": came back with other channels or scales; set them as they were");
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

// The device waited for others to open, and its queue may have been full.
void IioDevice::drop_early() {
  if (std::exchange(is_read_, true)) return;
  while (!device_->take().empty()) {
  }
}

void IioDevice::read(plugin::Samples& samples, const plugin::Wait& wait) {
  if (!device_ && !reopen(wait)) return;
  try {
    drop_early();
    wait.ready(device_->descriptor());
    if (wait.cancelled()) return;
    time_.look(host_);
    // Also without samples: it is asked whether it is still there.
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
