#include "drivers/can/device.h"

#include <fmt/format.h>

#include <algorithm>
#include <chrono>
#include <cmath>
#include <utility>

namespace imunoise::can {
namespace {

using std::chrono::milliseconds;

constexpr milliseconds kRetry{200};
constexpr milliseconds kSilence{2000};
constexpr int kMostAtOnce = 4096;

// To three digits: what a person would have configured.
double round_rate(double rate) {
  const double unit = std::pow(10.0, std::floor(std::log10(rate)) - 2.0);
  return std::round(rate / unit) * unit;
}

// When frames of a stream came.
struct Arrivals {
  std::uint64_t count = 0;
  std::int64_t first_ns = 0;
  std::int64_t last_ns = 0;

  void add(std::int64_t time_ns) {
    if (count++ == 0) first_ns = time_ns;
    last_ns = time_ns;
  }
  // Frames a second; 0: not known.
  double rate() const {
    if (count < 2 || last_ns <= first_ns) return 0.0;
    return static_cast<double>(count - 1) * 1e9 / static_cast<double>(last_ns - first_ns);
  }
};

template <class T>
T or_throw(Result<T> result) {
  if (!result) throw plugin::DeviceError(IMUNOISE_BAD_OPTION, result.error().message);
  return std::move(*result);
}

}  // namespace

CanDevice::CanDevice(Settings settings, const plugin::Host& host)
    : settings_(std::move(settings)),
      host_(host),
      streams_(or_throw(CanStream::all_of(settings_.channels))) {
  for (const CanStream& stream : streams_) {
    filters_.push_back({stream.message().id, stream.message().extended});
  }
  socket_.emplace(settings_.interface, filters_);
  listen();
  double slowest = 1.0;
  for (const CanStream& stream : streams_) {
    const double rate = stream.description().nominal_rate_hz;
    if (rate > 0.0) slowest = std::min(slowest, rate);
  }
  patience_ = std::max<Clock::duration>(
      kSilence,
      std::chrono::duration_cast<Clock::duration>(std::chrono::duration<double>(2.0 / slowest)));
  restart();
}

template <class Visit>
void CanDevice::for_streams_of(const drivers::CanFrame& frame, Visit visit) {
  const drivers::CanMessage* const message =
      settings_.channels.database().find(frame.id, frame.extended);
  if (message == nullptr) return;
  drivers::Refusals ignored;  // signals that are missing are counted by their streams
  drivers::decode_signals(*message, frame.data(), present_, ignored);
  for (std::size_t s = 0; s < streams_.size(); ++s) {
    if (&streams_[s].message() == message && streams_[s].is_in(present_)) visit(s);
  }
}

void CanDevice::listen() {
  std::vector<Arrivals> arrivals(streams_.size());
  const plugin::CancelSignal never;
  const plugin::Wait wait(never, settings_.listen);
  while (wait.ready(socket_->descriptor())) {
    while (const auto received = socket_->receive()) {
      if (received->frame.error) {
        trouble_.add_error(received->frame);
      } else {
        for_streams_of(received->frame, [&](std::size_t s) { arrivals[s].add(received->time_ns); });
      }
    }
  }
  std::vector<CanStream> came;
  for (std::size_t s = 0; s < streams_.size(); ++s) {
    if (arrivals[s].count == 0 && settings_.all_required) refuse_silence(&streams_[s]);
    if (arrivals[s].count == 0) continue;
    const double measured = arrivals[s].rate();
    CanStream& stream = came.emplace_back(std::move(streams_[s]));
    if (measured == 0.0) continue;
    stream.set_rate(settings_.rate_hz ? *settings_.rate_hz /
                                            std::max(1.0, std::round(*settings_.rate_hz / measured))
                                      : round_rate(measured));
  }
  if (came.empty()) refuse_silence(nullptr);
  streams_ = std::move(came);
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
  for (const CanStream& stream : streams_) out.streams.push_back(stream.description());
  out.product = settings_.product;
  out.serial = settings_.interface;
  return out;
}

void CanDevice::restart() {
  flags_.assign(streams_.size(), IMUNOISE_SAMPLE_AFTER_RESTART);
  for (CanStream& stream : streams_) stream.forget_counter();
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
  const std::int64_t time_ns = received.time_ns != 0 ? received.time_ns : host_.now_ns();
  for_streams_of(received.frame, [&](std::size_t s) {
    streams_[s].add(present_, s, time_ns, std::exchange(flags_[s], 0U), samples);
  });
}

void CanDevice::count_lost(std::uint32_t frames, plugin::Samples& samples) {
  trouble_.add_lost(frames);
  samples.refuse(0, plugin::Reason::kOverrun, frames);
  for (std::uint32_t& flags : flags_) flags |= IMUNOISE_SAMPLE_AFTER_GAP;
}

}  // namespace imunoise::can
