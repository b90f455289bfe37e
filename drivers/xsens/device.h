#pragma once

#include <chrono>
#include <cstdint>
#include <future>
#include <memory>
#include <optional>
#include <string>

#include "drivers/plugin/device.h"
#include "drivers/transport/serial_port.h"
#include "drivers/xsens/codec/frame.h"
#include "drivers/xsens/refusal_counter.h"
#include "drivers/xsens/rows.h"
#include "drivers/xsens/settings.h"
#include "drivers/xsens/setup.h"

namespace imunoise::xsens {

/// An Xsens MTi that measures. When it is unplugged or falls silent, it is looked for and
/// configured anew in a thread of its own, until it is back.
class XsensDevice final : public plugin::Device {
 public:
  /// Finds, configures and starts the device; seconds.
  XsensDevice(Settings settings, const plugin::Host& host);
  ~XsensDevice() override;

  drivers::DeviceInfo describe() override;
  void read(plugin::Samples& samples, const plugin::Wait& wait) override;

 private:
  using Clock = plugin::Wait::Clock;
  struct Started {
    std::unique_ptr<transport::SerialPort> port;
    std::uint32_t baud = 0;
    Setup setup;
    drivers::XbusParser rest;
  };

  static Started start(const Settings& settings, const plugin::CancelSignal& cancel,
                       const plugin::WireTap& tap);
  Started start_again() const;
  void measure(Started started);
  // Closes the port and begins to look for the device.
  void lose();
  // True once the device is back.
  bool recover(const plugin::Wait& wait);
  void receive(plugin::Samples& samples);
  void take_other(const drivers::XbusFrame& frame);

  Settings settings_;
  plugin::Host host_;
  plugin::WireTap wire_;  // called by the reader of the port: a recovery, or the reading thread
  plugin::CancelSignal closing_;
  Setup setup_;
  std::unique_ptr<RowMaker> rows_;
  std::unique_ptr<transport::SerialPort> port_;  // none while the device is looked for
  drivers::XbusParser parser_;
  RefusalCounter refused_;
  Clock::time_point last_sample_;
  std::int64_t last_host_ns_ = 0;  // host times do not run backwards
  std::int64_t period_ns_ = 0;
  std::future<Started> recovery_;
};

}  // namespace imunoise::xsens
