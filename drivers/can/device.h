#pragma once

#include <chrono>
#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include "drivers/can/bus_trouble.h"
#include "drivers/can/codec/channels.h"
#include "drivers/can/frame_streams.h"
#include "drivers/plugin/device.h"
#include "drivers/transport/can_socket.h"
#include "drivers/transport/kernel_time.h"

namespace imunoise::can {

/// What the user chose.
struct Settings {
  std::string interface;
  drivers::CanChannels channels;
  std::string product;            ///< Preset or database.
  bool all_required = false;      ///< Every mapped message must come; else those that do are taken.
  std::optional<double> rate_hz;  ///< Of the fastest message; others are whole fractions of it.
  std::chrono::milliseconds listen{1000};
};

/// A CAN IMU that sends by itself. Streams are the messages that came while it listened at the
/// beginning. An interface that goes down or away, and an IMU that falls silent, are waited for.
class CanDevice final : public plugin::Device {
 public:
  /// Opens the interface and listens.
  CanDevice(Settings settings, const plugin::Host& host);

  drivers::DeviceInfo describe() override;
  void read(plugin::Samples& samples, const plugin::Wait& wait) override;

 private:
  using Clock = plugin::Wait::Clock;

  void listen();
  template <class Enough>
  double hear(std::chrono::milliseconds time, Enough enough);
  [[noreturn]] void refuse_silence(const CanStream* missing) const;
  [[noreturn]] void refuse_rate(const CanStream& stream, double listened_s) const;
  bool reopen(const plugin::Wait& wait);
  void receive(plugin::Samples& samples);
  void take(const transport::ReceivedCanFrame& received, plugin::Samples& samples);
  void count_lost(std::uint32_t frames, plugin::Samples& samples);
  void fall_silent();
  void restart();
  void tap(const drivers::CanFrame& frame, std::int64_t time_ns) const;

  Settings settings_;
  plugin::Host host_;
  FrameStreams streams_;
  plugin::WireTap wire_;
  std::vector<transport::CanFilter> filters_;
  std::optional<transport::CanSocket> socket_;  // none while the interface is away
  transport::KernelTime time_;
  BusTrouble trouble_;
  Clock::time_point last_frame_;
  Clock::duration patience_{};
  bool silent_ = false;
  bool off_ = false;  // the controller went off the bus, and nothing came since
};

}  // namespace imunoise::can
