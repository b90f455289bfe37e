#pragma once

#include <optional>
#include <string>

#include "drivers/iio/buffered_device.h"
#include "drivers/plugin.h"
#include "drivers/transport/kernel_time.h"

namespace imunoise::iio {

/// One stream "imu" with all channels of an IIO device. A device that goes away is looked for by
/// its name at every read, and must come back with the channels, scales and rate that it had.
class IioDevice final : public plugin::Device {
 public:
  /// Throws as BufferedDevice does.
  IioDevice(Choice choice, const plugin::Host& host);

  drivers::DeviceInfo describe() override;
  void read(plugin::Samples& samples, const plugin::Wait& wait) override;

 private:
  bool reopen(const plugin::Wait& wait);
  void drop_early();

  Choice choice_;
  plugin::Host host_;
  std::optional<BufferedDevice> device_;  // none: it is away
  bool is_read_ = false;                  // since it was opened
  drivers::DeviceInfo info_;
  transport::KernelTime time_;
  std::uint32_t next_flags_ = IMUNOISE_SAMPLE_AFTER_RESTART;
};

}  // namespace imunoise::iio
