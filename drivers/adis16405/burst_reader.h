#pragma once

// From queued bursts to samples.

#include <array>
#include <cstddef>
#include <cstdint>
#include <deque>
#include <vector>

#include "drivers/adis16405/bridges/spi_bus.h"
#include "drivers/adis16405/burst_rows.h"
#include "drivers/adis16405/sensor.h"
#include "drivers/adis16405/settings.h"
#include "drivers/plugin.h"

namespace imunoise::drivers::adis16405 {

/// Keeps bursts queued in the bridge, about 0.15 s ahead, and adds what comes as BurstRows does.
/// What follows a queue that ran dry, or may have, is marked IMUNOISE_SAMPLE_AFTER_GAP. One thread
/// at a time; throws plugin::DeviceError.
class BurstReader {
 public:
  /// Borrows the bus, which a Sensor has started. `poll`: bursts back to back, most of them stale;
  /// else one at each data-ready.
  /// `wire`: receives each burst as it came; may be empty.
  BurstReader(SpiBus& bus, const Settings& settings, bool poll, Note note, plugin::WireTap wire);

  /// Waits at most `timeout` for an answer and takes all that are there.
  void read(plugin::Samples& samples, usb::Duration timeout);
  /// Time since the last sample of stream "imu".
  usb::Duration silence() const { return bus_.now() - last_sample_; }

 private:
  enum class Question : std::uint8_t { kBurst, kFirstBurst, kDiagnosisCommand, kDiagnosis };
  static bool is_burst(Question question) {
    return question == Question::kBurst || question == Question::kFirstBurst;
  }
  bool take_answers(plugin::Samples& samples, usb::Duration timeout);
  void top_up();
  Question next_burst();
  void correct_times(std::vector<SpiAnswer>& answers);
  void send_diagnosis();
  void take(const SpiAnswer& answer, plugin::Samples& samples);
  void take_burst(Question question, const SpiAnswer& answer, plugin::Samples& samples);
  void take_diagnosis(const SpiAnswer& answer);
  SpiFrame burst_frame() const;

  SpiBus& bus_;
  bool poll_;
  Note note_;
  plugin::WireTap wire_;
  std::int64_t least_period_ns_;  // between two bursts
  std::size_t ahead_;             // bursts to keep queued
  std::size_t bursts_ = 0;        // queued now
  std::deque<Question> questions_;
  BurstRows rows_;
  usb::Duration last_sample_;
  std::int64_t last_time_ns_ = 0;  // of an answer
  bool resumes_ = false;  // the next burst to be sent follows a queue that may have run dry
  bool started_ = false;
  bool wants_diagnosis_ = false;
  std::uint16_t diagnosis_ = 0;  // as last noted
  usb::Duration next_diagnosis_;
};

}  // namespace imunoise::drivers::adis16405
