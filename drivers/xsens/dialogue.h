#pragma once

#include <chrono>
#include <cstdint>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "drivers/plugin/wait.h"
#include "drivers/transport/serial_port.h"
#include "drivers/xsens/codec/frame.h"
#include "drivers/xsens/codec/messages.h"

namespace imunoise::xsens {

using Payload = std::vector<std::uint8_t>;

/// What became of a request. Neither: the device was silent.
struct Answer {
  std::optional<Payload> payload;     ///< The device acknowledged.
  std::optional<std::uint8_t> error;  ///< The device sent an Error message with this code.
};

/// Requests and their answers, among whatever else comes over the line. Throws plugin::DeviceError:
/// IMUNOISE_DISCONNECTED, or IMUNOISE_CANCELLED once it is cancelled. Borrows port and signal.
class Dialogue {
 public:
  Dialogue(transport::SerialPort& port, const plugin::CancelSignal& cancel)
      : port_(port), cancel_(cancel) {}

  /// Asks up to three times.
  Answer ask(drivers::XsensMessage request, drivers::Bytes payload = {});
  /// The answer's payload. Throws IMUNOISE_BAD_DEVICE where there is none.
  Payload require(drivers::XsensMessage request, drivers::Bytes payload = {});
  /// Sends GoToConfig ten times a second until the device acknowledges. False: it did not in time.
  bool go_to_config(std::chrono::milliseconds patience);
  void send(drivers::XsensMessage message, drivers::Bytes payload = {});

  /// What has come so far: nothing, bytes, or at least one whole message.
  bool heard_bytes() const { return heard_bytes_; }
  bool heard_messages() const { return heard_messages_; }

  /// What came behind the last answer: measured data begins there.
  drivers::XbusParser take_rest() { return std::move(parser_); }

  const std::string& path() const { return port_.path(); }

 private:
  Answer wait_for(std::uint8_t acknowledgement, std::chrono::milliseconds patience);

  transport::SerialPort& port_;
  const plugin::CancelSignal& cancel_;
  drivers::XbusParser parser_;
  bool heard_bytes_ = false;
  bool heard_messages_ = false;
};

}  // namespace imunoise::xsens
