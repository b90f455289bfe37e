#include "drivers/emulator/sensors/can_imu.h"

#include <linux/can/error.h>

#include <cmath>

#include "drivers/emulator/measurement/channel_value.h"

namespace imunoise::emulator {
namespace {

using drivers::CanFrame;
using drivers::CanMessage;
using drivers::CanSignal;

constexpr double kTicksPerSecond = 10'000.0;

// An IMU saturates where its signal ends, or below the codes that mean "not valid".
double saturated(const drivers::ChannelMapping& mapping, const CanSignal& signal, double value) {
  using drivers::SignalType;
  if (signal.type == SignalType::kFloat32 || signal.type == SignalType::kFloat64) return value;
  const bool is_signed = signal.type == SignalType::kSigned;
  const double above = std::ldexp(1.0, static_cast<int>(signal.field.length) - (is_signed ? 1 : 0));
  const double last =
      mapping.invalid_from ? static_cast<double>(*mapping.invalid_from) - 1.0 : above - 1.0;
  const double number = (value - signal.offset) / signal.factor;
  if (number < (is_signed ? -above : 0.0)) {
    return (is_signed ? -above : 0.0) * signal.factor + signal.offset;
  }
  return number > last ? last * signal.factor + signal.offset : value;
}

}  // namespace

CanImu::CanImu(drivers::CanChannels channels, double rate_hz, SampleSource& source, CanLine& line,
               std::vector<Fault> faults, Memory memory)
    : channels_(std::move(channels)),
      rate_hz_(rate_hz),
      source_(source),
      line_(line),
      faults_(std::move(faults)),
      sent_(memory),
      thread_([this](const std::stop_token& stop) { run(stop); }) {}

std::vector<SentCanFrame> CanImu::sent() const {
  const std::lock_guard lock(mutex_);
  return sent_.items();
}

std::size_t CanImu::frames() const {
  const std::lock_guard lock(mutex_);
  return sent_.size();
}

void CanImu::run(const std::stop_token& stop) {
  const auto start = std::chrono::steady_clock::now();
  for (std::uint64_t sample = 0; !stop.stop_requested(); ++sample) {
    const std::chrono::duration<double> due(static_cast<double>(sample) / rate_hz_);
    std::this_thread::sleep_until(start +
                                  std::chrono::duration_cast<std::chrono::nanoseconds>(due));
    send_sample(sample);
  }
}

double CanImu::value(const drivers::ChannelMapping& mapping, const CanSignal& signal,
                     const Measurement& measurement, std::uint64_t sample) const {
  if (mapping.channel == "counter") {
    const double steps = mapping.last ? static_cast<double>(*mapping.last) + 1.0
                                      : std::ldexp(1.0, static_cast<int>(signal.field.length));
    return std::fmod(static_cast<double>(sample), steps);
  }
  if (mapping.channel == "sample_time") {
    return std::floor(static_cast<double>(sample) / rate_hz_ * kTicksPerSecond);
  }
  return saturated(mapping, signal, value_in_unit(measurement, mapping.channel, mapping.unit));
}

std::vector<CanImu::Composed> CanImu::compose(std::uint64_t sample) {
  const Measurement measurement = source_.measure(static_cast<double>(sample) / rate_hz_);
  std::vector<Composed> out;
  for (const CanMessage& message : channels_.database().messages()) {
    const auto& mapped = channels_.channels_of(message);
    SentCanFrame record{message.name, sample, {}, true};
    std::vector<std::pair<std::string_view, double>> physical;
    for (std::size_t i = 0; i < message.signals.size(); ++i) {
      const CanSignal& signal = message.signals[i];
      if (!mapped[i] || signal.switched_by) continue;
      record.values.emplace_back(mapped[i]->mapping.channel,
                                 value(mapped[i]->mapping, signal, measurement, sample));
      physical.emplace_back(signal.name, record.values.back().second);
    }
    if (physical.empty()) continue;
    out.push_back({std::move(record), drivers::encode_signals(message, physical).value()});
  }
  return out;
}

// As a controller that sees trouble on the bus reports it.
void CanImu::report_error(std::uint32_t kind) {
  CanFrame frame;
  frame.error = true;
  frame.id = kind;
  frame.length = CAN_ERR_DLC;
  line_.send(frame);
}

void CanImu::put_on_bus(Composed composed) {
  const std::lock_guard lock(mutex_);  // who has received a frame finds it in sent()
  if (composed.record.sent) composed.record.sent = line_.send(composed.frame);
  sent_.push_back(std::move(composed.record));
}

void CanImu::send_sample(std::uint64_t sample) {
  const auto fault = faults_.at(sample);
  bool sent = sample >= bus_off_until_;
  if (sample == bus_off_until_ && sample > 0) report_error(CAN_ERR_RESTARTED);
  if (fault) {
    switch (fault->kind) {
      case Fault::Kind::kBitError:
        report_error(CAN_ERR_PROT | CAN_ERR_BUSERROR);
        break;
      case Fault::Kind::kUnplug:
        report_error(CAN_ERR_BUSOFF);
        bus_off_until_ = sample + fault->count;
        sent = false;
        break;
      case Fault::Kind::kLoss:
      case Fault::Kind::kStall:
        sent = false;
        break;
      case Fault::Kind::kLate:
        break;
    }
  }
  for (Composed& composed : compose(sample)) {
    composed.record.sent = sent;
    held_back_.push_back(std::move(composed));
  }
  if (fault && fault->kind == Fault::Kind::kLate) return;
  for (Composed& composed : std::exchange(held_back_, {})) put_on_bus(std::move(composed));
}

}  // namespace imunoise::emulator
