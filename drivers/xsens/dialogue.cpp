#include "drivers/xsens/dialogue.h"

#include <fmt/format.h>

#include <array>

#include "drivers/plugin/device.h"

namespace imunoise::xsens {
namespace {

using drivers::XsensMessage;
using std::chrono::milliseconds;

constexpr int kAttempts = 3;
constexpr milliseconds kPatience{500};
constexpr milliseconds kKnockInterval{100};

}  // namespace

void Dialogue::send(XsensMessage message, drivers::Bytes payload) {
  port_.write(drivers::encode_message(message, payload));
}

Answer Dialogue::wait_for(std::uint8_t acknowledgement, milliseconds patience) {
  const plugin::Wait wait(cancel_, patience);
  for (;;) {
    while (const auto frame = parser_.next()) {
      heard_messages_ = true;
      const Payload payload(frame->payload.begin(), frame->payload.end());
      if (frame->message_id == acknowledgement) return {payload, std::nullopt};
      switch (static_cast<XsensMessage>(frame->message_id)) {
        case XsensMessage::kError:
          return {std::nullopt, payload.empty() ? std::uint8_t{0} : payload.front()};
        case XsensMessage::kWakeUp:  // a device that starts stays in configuration if it is
                                     // answered
          send(XsensMessage::kWakeUpAcknowledge);
          break;
        default:
          break;
      }
    }
    if (!wait.ready(port_.descriptor())) {
      if (!wait.cancelled()) return {};
      throw plugin::DeviceError(IMUNOISE_CANCELLED, port_.path() + ": cancelled");
    }
    std::array<std::uint8_t, 4096> bytes;
    const std::size_t count = port_.read(bytes);
    heard_bytes_ = heard_bytes_ || count > 0;
    parser_.push(drivers::Bytes(bytes).first(count));
  }
}

Answer Dialogue::ask(XsensMessage request, drivers::Bytes payload) {
  for (int attempt = 0; attempt < kAttempts; ++attempt) {
    send(request, payload);
    Answer answer = wait_for(drivers::acknowledged_by(request), kPatience);
    if (answer.payload || answer.error) return answer;
  }
  return {};
}

Payload Dialogue::require(XsensMessage request, drivers::Bytes payload) {
  Answer answer = ask(request, payload);
  if (answer.payload) return std::move(*answer.payload);
  const std::string why = answer.error ? std::string(drivers::error_text(*answer.error))
                                       : "no answer; unplug it and plug it in again";
  throw plugin::DeviceError(IMUNOISE_BAD_DEVICE,
                            fmt::format("{}: the device refuses message 0x{:02x}: {}", port_.path(),
                                        static_cast<unsigned>(request), why));
}

bool Dialogue::go_to_config(milliseconds patience) {
  const auto acknowledgement = drivers::acknowledged_by(XsensMessage::kGoToConfig);
  for (auto left = patience; left > milliseconds(0); left -= kKnockInterval) {
    send(XsensMessage::kGoToConfig);
    if (wait_for(acknowledgement, kKnockInterval).payload) return true;
  }
  return false;
}

}  // namespace imunoise::xsens
