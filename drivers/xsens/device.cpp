#include "drivers/xsens/device.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <utility>
#include <vector>

#include "drivers/xsens/codec/messages.h"
#include "drivers/xsens/dialogue.h"
#include "drivers/xsens/search.h"

namespace imunoise::xsens {
namespace {

using drivers::XbusFrame;
using drivers::XsensMessage;
using std::chrono::milliseconds;

constexpr milliseconds kRetry{200};
constexpr milliseconds kGlance{20};
constexpr milliseconds kSilence{2000};

bool carries_samples(const XbusFrame& frame) {
  const auto message = static_cast<XsensMessage>(frame.message_id);
  return message == XsensMessage::kMtData2 || message == XsensMessage::kMtData;
}

// Whether trying again may help: the port is away, or the device still boots.
bool may_pass(const plugin::DeviceError& error) {
  return error.code() != IMUNOISE_BAD_OPTION && error.code() != IMUNOISE_FAILED;
}

}  // namespace

XsensDevice::Started XsensDevice::start(const Settings& settings,
                                        const plugin::CancelSignal& cancel,
                                        const plugin::WireTap& tap) {
  FoundDevice found = find_device(settings.port, settings.baud, cancel, tap);
  Dialogue dialogue(*found.port, cancel);
  Setup setup = configure(dialogue, settings);
  return {std::move(found.port), found.baud, std::move(setup), dialogue.take_rest()};
}

XsensDevice::Started XsensDevice::start_again() const {
  for (;;) {
    try {
      Started out = start(settings_, closing_, wire_);
      if (out.setup.serial == setup_.serial && out.setup.sends == setup_.sends) return out;
      throw plugin::DeviceError(IMUNOISE_FAILED,
                                fmt::format("{}: found another device or configuration ({} {} "
                                            "instead of {} {}); begin a new recording",
                                            settings_.port, out.setup.product, out.setup.serial,
                                            setup_.product, setup_.serial));
    } catch (const plugin::DeviceError& error) {
      if (!may_pass(error) || closing_.is_set()) throw;
    }
    const plugin::Wait pause(closing_, kRetry);
    pause.until(pause.deadline());
  }
}

XsensDevice::XsensDevice(Settings settings, const plugin::Host& host)
    : settings_(std::move(settings)), host_(host), wire_(host.wire_tap()) {
  Started started = start(settings_, host_.opening(), wire_);
  setup_ = started.setup;
  rows_ = RowMaker::make(setup_);
  period_ns_ = std::llround(1e9 / rows_->streams().front().nominal_rate_hz);
  host_.note(fmt::format("{}: {} {} at {} baud", settings_.port, setup_.product, setup_.serial,
                         started.baud));
  measure(std::move(started));
}

XsensDevice::~XsensDevice() {
  closing_.set();  // ends a recovery; its future waits for that
}

void XsensDevice::measure(Started started) {
  port_ = std::move(started.port);
  settings_.baud = started.baud;  // where to look for it first, should it go
  parser_ = std::move(started.rest);
  refused_.begin(parser_);
  rows_->restart();
  last_host_ns_ = 0;
  last_sample_ = Clock::now();
}

drivers::DeviceInfo XsensDevice::describe() {
  return {rows_->streams(), setup_.product, setup_.serial, setup_.firmware};
}

void XsensDevice::lose() {
  port_.reset();
  recovery_ = std::async(std::launch::async, [this] { return start_again(); });
}

bool XsensDevice::recover(const plugin::Wait& wait) {
  while (recovery_.wait_for(milliseconds(0)) != std::future_status::ready) {
    if (!wait.until(Clock::now() + kGlance)) return false;
  }
  measure(recovery_.get());
  host_.note(settings_.port + ": the device is back");
  return true;
}

void XsensDevice::read(plugin::Samples& samples, const plugin::Wait& wait) {
  if (!port_ && !recover(wait)) return;
  try {
    if (wait.ready(port_->descriptor())) receive(samples);
  } catch (const plugin::DeviceError& error) {
    if (error.code() == IMUNOISE_DISCONNECTED) lose();
    throw;
  }
  const auto patience =
      std::max<Clock::duration>(kSilence, std::chrono::nanoseconds(20 * period_ns_));
  if (Clock::now() - last_sample_ > patience) {
    lose();
    throw plugin::DeviceError(IMUNOISE_DISCONNECTED,
                              settings_.port + ": no data any more; is the device powered?");
  }
}

void XsensDevice::receive(plugin::Samples& samples) {
  std::array<std::uint8_t, 8192> bytes;
  const std::size_t count = port_->read(bytes);
  const std::int64_t now_ns = host_.now_ns();
  parser_.push(drivers::Bytes(bytes).first(count));
  std::vector<XbusFrame> frames;
  while (const auto frame = parser_.next()) frames.push_back(*frame);
  refused_.count(parser_, samples);
  // Of messages that came together only the last came now; the others waited in a buffer.
  auto waited = std::count_if(frames.begin(), frames.end(), carries_samples);
  for (const XbusFrame& frame : frames) {
    if (!carries_samples(frame)) {
      take_other(frame);
      continue;
    }
    --waited;
    last_host_ns_ = std::max(last_host_ns_, now_ns - waited * period_ns_);
    rows_->add(frame, last_host_ns_, samples);
    last_sample_ = Clock::now();
  }
}

void XsensDevice::take_other(const XbusFrame& frame) {
  switch (static_cast<XsensMessage>(frame.message_id)) {
    case XsensMessage::kWakeUp:
      rows_->restart();
      return host_.note(settings_.port + ": the device restarted; check its power supply");
    case XsensMessage::kError:
      return host_.note(fmt::format(
          "{}: the device says: {}", settings_.port,
          drivers::error_text(frame.payload.empty() ? std::uint8_t{0} : frame.payload.front())));
    default:
      return;
  }
}

}  // namespace imunoise::xsens
