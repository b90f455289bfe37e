#pragma once

// An Xsens MTi without its line: bytes in, bytes out, no clock.

#include <cstdint>
#include <string>
#include <utility>
#include <vector>

#include "drivers/codec/bytes.h"
#include "drivers/emulator/measurement/sample_source.h"
#include "drivers/xsens/codec/frame.h"
#include "drivers/xsens/codec/legacy.h"
#include "drivers/xsens/codec/messages.h"

namespace imunoise::emulator {

struct MtiOptions {
  bool fourth_generation = true;  ///< MTi-G-710; else MTi-G, which knows legacy MTData only.
  std::string product = "MTi-G-710-2A8G4";
  std::uint32_t device_id = 0x0770'0123;
  std::uint32_t baud = 115200;
  std::uint16_t first_counter = 0;       ///< When power comes on.
  std::uint32_t first_ticks = 0;         ///< SampleTimeFine then, 100 µs.
  std::uint16_t field_rate_limit = 100;  ///< Hz: it sends the magnetic field no faster.
  bool deaf_until_reset = false;         ///< Ignores all but Reset, as a device was seen to do.
  bool self_test_passed = true;
};

/// One message of measured data as it was meant.
struct MtiMessage {
  std::uint16_t counter = 0;
  std::uint32_t ticks = 0;   ///< SampleTimeFine; 0 in legacy MTData.
  std::uint32_t status = 0;  ///< Status word.
  /// In the device's units, before they are rounded to the number format.
  std::vector<std::pair<std::string, double>> values;
  std::vector<std::uint8_t> frame;  ///< As it goes over the line.
};

/// The device's side of Xbus: configuration, reset, baud rate, measurement. Accelerations beyond
/// ±50 m/s² and rates beyond ±7.8 rad/s are clipped, and the status word says so.
class XsensMti {
 public:
  /// Borrows the source.
  XsensMti(MtiOptions options, SampleSource& source);

  /// Power comes on: counter and time begin anew; it measures as it was configured last.
  void power_on();
  /// Takes what the host wrote and returns what the device answers.
  std::vector<std::uint8_t> receive(drivers::Bytes bytes);
  bool measuring() const { return measuring_; }
  /// Measuring because the host said so, not because power came on.
  bool ordered() const { return ordered_; }
  double rate_hz() const;
  std::uint32_t baud() const { return options_.baud; }
  /// The next message; with a WakeUp before the first one that no host ordered: power came on.
  MtiMessage measure();

  /// How often the host wrote the output configuration (the device's memory wears).
  std::uint64_t writes() const { return writes_; }

 private:
  void take(const drivers::XbusFrame& frame);
  void configure(drivers::XsensMessage message, drivers::Bytes payload);
  void take_output_configuration(drivers::Bytes payload);
  void answer(drivers::XsensMessage message, drivers::Bytes payload = {});
  void refuse(std::uint8_t error);
  void fill_mtdata2(const Measurement& sample, MtiMessage& out) const;
  void fill_legacy(const Measurement& sample, MtiMessage& out) const;

  MtiOptions options_;
  SampleSource& source_;
  drivers::XbusParser parser_;
  std::vector<std::uint8_t> answers_;
  std::vector<drivers::XsensOutput> outputs_;  // none: legacy MTData
  drivers::XsensConfiguration legacy_;
  std::uint32_t next_baud_;
  std::uint64_t measured_ = 0;  // messages since power came on
  std::uint64_t writes_ = 0;
  int knocks_until_heard_ = 0;  // after a reset of a deaf device
  bool measuring_ = true;
  bool ordered_ = false;
  bool deaf_;
};

}  // namespace imunoise::emulator
