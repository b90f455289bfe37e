#include "drivers/can/device.h"

#include <fmt/format.h>

#include <algorithm>
#include <chrono>
#include <utility>

#include "drivers/can/codec/candump.h"
#include "drivers/plugin/or_throw.h"

namespace imunoise::can {
namespace {

using std::chrono::milliseconds;

constexpr milliseconds kRetry{200};
constexpr milliseconds kSilence{2000};
constexpr int kMostAtOnce = 4096;
constexpr int kLonger = 4;  // times as long as asked for, for messages that came once

std::string no_rate(const CanStream& stream, double listened_s) {
  return fmt::format(
      "message {} (0x{:x}) came once in {:.3g} s, too few to derive its rate; give the rate of the "
      "fastest message (rate=100), or listen longer (listen=10)",
      stream.message().name, stream.message().id, listened_s);
}

}  // namespace

CanDevice::CanDevice(Settings settings, const plugin::Host& host)
    : settings_(std::move(settings)),
      host_(host),
      streams_(plugin::or_throw(FrameStreams::make(settings_.channels))),
      wire_(host.wire_tap()) {
  for (const CanStream& stream : streams_.streams()) {
    filters_.push_back({stream.message().id, stream.message().extended});
  }
  socket_.emplace(settings_.interface, filters_);
  listen();
  double slowest = 1.0;
  for (const CanStream& stream : streams_.streams()) {
    const double rate = stream.description().nominal_rate_hz;
    if (rate > 0.0) slowest = std::min(slowest, rate);
  }
  patience_ = std::max<Clock::duration>(
      kSilence,
      std::chrono::duration_cast<Clock::duration>(std::chrono::duration<double>(2.0 / slowest)));
  restart();
}

// For so long, or until it is enough; returns how long it took, s.
template <class Enough>
double CanDevice::hear(milliseconds time, Enough enough) {
  const Clock::time_point begin = Clock::now();
  const plugin::Wait wait(host_.opening(), time);
  while (!enough() && wait.ready(socket_->descriptor())) {
    time_.look(host_);
    while (const auto received = socket_->receive()) {
      if (received->frame.error) {
        trouble_.add_error(received->frame);
      } else {
        streams_.hear(received->frame, time_.host_time_ns(received->time_ns));
      }
    }
  }
  if (wait.cancelled())
    throw plugin::DeviceError(IMUNOISE_CANCELLED, settings_.interface + ": cancelled");
  return std::chrono::duration<double>(Clock::now() - begin).count();
}

void CanDevice::listen() {
  double listened = hear(settings_.listen, [] { return false; });
  const CanStream* const missing = streams_.missing();
  if (missing != nullptr && settings_.all_required) refuse_silence(missing);
  // One frame tells no rate: the next is waited for.
  listened +=
      hear(kLonger * settings_.listen, [this] { return streams_.without_rate() == nullptr; });
  const CanStream* const unknown = streams_.without_rate();
  if (unknown != nullptr && !settings_.rate_hz && settings_.all_required)
    refuse_rate(*unknown, listened);
  std::vector<CanStream> left_out = streams_.settle(settings_.rate_hz, listened);
  if (streams_.streams().empty() && !left_out.empty()) refuse_rate(left_out.front(), listened);
  if (streams_.streams().empty()) refuse_silence(nullptr);
  for (const CanStream& one : left_out) {
    host_.note(
        fmt::format("{}: {}; it is not recorded", settings_.interface, no_rate(one, listened)));
  }
}

void CanDevice::refuse_rate(const CanStream& stream, double listened_s) const {
  throw plugin::DeviceError(IMUNOISE_NOT_FOUND,
                            settings_.interface + ": " + no_rate(stream, listened_s));
}

void CanDevice::refuse_silence(const CanStream* missing) const {
  const double seconds = std::chrono::duration<double>(settings_.listen).count();
  std::string text;
  if (missing != nullptr) {
    text = fmt::format(
        "no message {} (0x{:x}) in {:g} s; is it switched on in the IMU? For slow "
        "messages listen longer (listen=10)",
        missing->message().name, missing->message().id, seconds);
  } else if (trouble_.errors() > 0) {
    text = fmt::format(
        "{} error frames and no message of the IMU in {:g} s; is the interface's "
        "bit rate the IMU's (ip -details link show {})?",
        trouble_.errors(), seconds, settings_.interface);
  } else {
    text = fmt::format(
        "no message of the IMU in {:g} s; is it powered, does it send by itself, "
        "and do its identifiers fit {}?",
        seconds, settings_.product);
  }
  throw plugin::DeviceError(IMUNOISE_NOT_FOUND, settings_.interface + ": " + text);
}

drivers::DeviceInfo CanDevice::describe() {
  drivers::DeviceInfo out;
  out.streams = streams_.descriptions();
  out.product = settings_.product;
  out.serial = settings_.interface;
  return out;
}

void CanDevice::restart() {
  streams_.restart();
  last_frame_ = Clock::now();
}

bool CanDevice::reopen(const plugin::Wait& wait) {
  for (;;) {
    try {
      socket_.emplace(settings_.interface, filters_);
      restart();
      host_.note(settings_.interface + ": the interface is back");
      return true;
    } catch (const plugin::DeviceError& error) {
      if (error.code() != IMUNOISE_NOT_FOUND) throw;
    }
    if (!wait.until(Clock::now() + kRetry)) return false;
  }
}

void CanDevice::read(plugin::Samples& samples, const plugin::Wait& wait) {
  if (!socket_ && !reopen(wait)) return;
  try {
    if (wait.ready(socket_->descriptor())) receive(samples);
  } catch (const plugin::DeviceError& error) {
    if (error.code() == IMUNOISE_DISCONNECTED) socket_.reset();
    throw;
  }
  if (const auto report = trouble_.report(host_.now_ns())) {
    host_.note(fmt::format("{}: {}", settings_.interface, *report));
  }
  if (!silent_ && Clock::now() - last_frame_ > patience_) fall_silent();
}

void CanDevice::fall_silent() {
  silent_ = true;
  restart();
  throw plugin::DeviceError(
      IMUNOISE_DISCONNECTED,
      settings_.interface +
          (off_ ? ": the controller went off the bus; check the wiring, then ip link set " +
                      settings_.interface + " type can restart"
                : std::string(": the IMU sends no more; is it powered?")));
}

void CanDevice::receive(plugin::Samples& samples) {
  time_.look(host_);
  for (int i = 0; i < kMostAtOnce; ++i) {
    const auto received = socket_->receive();
    if (!received) return;
    if (received->lost > 0) count_lost(received->lost, samples);
    if (received->frame.error) {
      off_ = trouble_.add_error(received->frame) || off_;
    } else {
      take(*received, samples);
    }
  }
}

void CanDevice::take(const transport::ReceivedCanFrame& received, plugin::Samples& samples) {
  last_frame_ = Clock::now();
  off_ = false;
  if (std::exchange(silent_, false)) host_.note(settings_.interface + ": the IMU sends again");
  const std::int64_t time_ns = time_.host_time_ns(received.time_ns);
  if (wire_) tap(received.frame, time_ns);
  streams_.take(received.frame, time_ns, samples);
}

void CanDevice::tap(const drivers::CanFrame& frame, std::int64_t time_ns) const {
  // A name of one word, whatever the bus is called here.
  const std::string_view name =
      std::string_view(settings_.interface).substr(0, settings_.interface.find_first_of(" /"));
  const std::string line =
      drivers::format_candump_line({time_ns, name, frame, drivers::CanDirection::kUnknown}) + "\n";
  wire_(drivers::Bytes(static_cast<const std::uint8_t*>(static_cast<const void*>(line.data())),
                       line.size()));
}

void CanDevice::count_lost(std::uint32_t frames, plugin::Samples& samples) {
  trouble_.add_lost(frames);
  samples.refuse(0, plugin::Reason::kOverrun, frames);
  streams_.mark(IMUNOISE_SAMPLE_AFTER_GAP);
}

}  // namespace imunoise::can
