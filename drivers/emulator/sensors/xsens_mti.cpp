#include "drivers/emulator/sensors/xsens_mti.h"

#include <algorithm>
#include <cmath>

#include "drivers/emulator/measurement/channel_value.h"
#include "drivers/xsens/codec/items.h"
#include "drivers/xsens/codec/mtdata2.h"
#include "drivers/xsens/codec/sample_clock.h"

namespace imunoise::emulator {
namespace {

using drivers::Bytes;
using drivers::XsensFormat;
using drivers::XsensItem;
using drivers::XsensMessage;
using drivers::XsensOutput;

constexpr std::uint8_t kInvalidMessage = 0x04;
constexpr std::uint8_t kBadBaud = 0x20;
constexpr std::uint8_t kBadParameter = 0x21;
constexpr double kTicksPerSecond = 10'000.0;
constexpr double kAccelerationRange = 50.0;
constexpr double kRateRange = 7.8;
constexpr int kDeafKnocks = 5;

// Limits a vector to a range and sets the bits of what was clipped, from `bit` on.
void clip(std::array<double, 3>& vector, double range, unsigned bit, std::uint32_t& status) {
  for (std::size_t axis = 0; axis < 3; ++axis) {
    const double inside = std::clamp(vector[axis], -range, range);
    if (inside != vector[axis]) status |= 1U << (bit + axis) | 1U << 19U;
    vector[axis] = inside;
  }
}

}  // namespace

XsensMti::XsensMti(MtiOptions options, SampleSource& source)
    : options_(std::move(options)),
      source_(source),
      next_baud_(options_.baud),
      deaf_(options_.deaf_until_reset) {
  legacy_.device_id = options_.device_id;
  legacy_.period = drivers::legacy_period(100.0);
  legacy_.layout = drivers::calibrated_layout({}, XsensFormat::kFloat32);
  if (options_.fourth_generation) {
    outputs_ = {{static_cast<std::uint16_t>(XsensItem::kPacketCounter), 0xffff},
                {static_cast<std::uint16_t>(XsensItem::kQuaternion), 100}};
  }
}

void XsensMti::power_on() {
  measured_ = 0;
  measuring_ = true;
  ordered_ = false;
}

std::vector<std::uint8_t> XsensMti::receive(Bytes bytes) {
  answers_.clear();
  parser_.push(bytes);
  while (const auto frame = parser_.next()) take(*frame);
  return answers_;
}

void XsensMti::answer(XsensMessage message, Bytes payload) {
  const auto frame = drivers::encode_message(message, payload);
  answers_.insert(answers_.end(), frame.begin(), frame.end());
}

void XsensMti::refuse(std::uint8_t error) {
  answer(XsensMessage::kError, drivers::payload_of(error));
}

void XsensMti::take(const drivers::XbusFrame& frame) {
  const auto message = static_cast<XsensMessage>(frame.message_id);
  if (deaf_ && message != XsensMessage::kReset) return;
  switch (message) {
    case XsensMessage::kReset:
      knocks_until_heard_ = deaf_ ? kDeafKnocks : 0;
      deaf_ = false;
      options_.baud = next_baud_;
      power_on();
      break;
    case XsensMessage::kWakeUpAcknowledge:
      if (knocks_until_heard_ == 0) measuring_ = false;
      return;
    case XsensMessage::kGoToConfig:
      if (knocks_until_heard_ > 0 && --knocks_until_heard_ > 0) return;
      measuring_ = false;
      break;
    default:
      if (!measuring_) configure(message, frame.payload);
      return;
  }
  answer(static_cast<XsensMessage>(drivers::acknowledged_by(message)));
}

void XsensMti::configure(XsensMessage message, Bytes payload) {
  drivers::BigEndianReader in(payload);
  switch (message) {
    case XsensMessage::kRequestDeviceId:
      return answer(XsensMessage::kDeviceId, drivers::payload_of(options_.device_id));
    case XsensMessage::kRequestProductCode:
      return answer(XsensMessage::kProductCode,
                    std::vector<std::uint8_t>(options_.product.begin(), options_.product.end()));
    case XsensMessage::kRequestFirmwareRevision:
      return answer(XsensMessage::kFirmwareRevision, std::array<std::uint8_t, 3>{1, 8, 2});
    case XsensMessage::kSetOutputConfiguration:
      return take_output_configuration(payload);
    case XsensMessage::kRequestConfiguration:
      return answer(XsensMessage::kConfiguration, drivers::encode_configuration(legacy_));
    case XsensMessage::kSetBaudRate: {
      const auto baud = drivers::baud_rate_of(in.take<std::uint8_t>());
      if (!baud) return refuse(kBadBaud);
      next_baud_ = *baud;
      break;
    }
    case XsensMessage::kSetPeriod:
      legacy_.period = in.take<std::uint16_t>();
      break;
    case XsensMessage::kSetOutputSkipFactor:
      legacy_.skip_factor = in.take<std::uint16_t>();
      break;
    case XsensMessage::kSetOutputMode:
      legacy_.layout.mode = in.take<std::uint16_t>();
      break;
    case XsensMessage::kSetOutputSettings:
      legacy_.layout.settings = in.take<std::uint32_t>();
      ++writes_;
      break;
    case XsensMessage::kGoToMeasurement:
      measuring_ = ordered_ = true;
      break;
    default:
      return refuse(kInvalidMessage);
  }
  answer(static_cast<XsensMessage>(drivers::acknowledged_by(message)));
}

void XsensMti::take_output_configuration(Bytes payload) {
  if (!options_.fourth_generation) return refuse(kInvalidMessage);
  if (!payload.empty()) {
    auto wanted = drivers::decode_output_configuration(payload);
    if (!wanted) return refuse(kBadParameter);
    for (XsensOutput& output : *wanted) {
      if (drivers::kind_of(output.data_id) == XsensItem::kMagneticField) {
        output.rate_hz = std::min(output.rate_hz, options_.field_rate_limit);
      }
    }
    outputs_ = *wanted == std::vector<XsensOutput>{{0, 0}} ? std::vector<XsensOutput>{} : *wanted;
    ++writes_;
  }
  answer(XsensMessage::kOutputConfiguration, drivers::payload_of(outputs_));
}

double XsensMti::rate_hz() const {
  if (outputs_.empty()) return drivers::rate_of(legacy_);
  std::uint16_t out = 1;
  for (const XsensOutput& output : outputs_) {
    if (output.rate_hz != 0xffff) out = std::max(out, output.rate_hz);
  }
  return out;
}

MtiMessage XsensMti::measure() {
  const double seconds = static_cast<double>(measured_) / rate_hz();
  Measurement sample = source_.measure(seconds);
  MtiMessage out;
  out.counter = static_cast<std::uint16_t>(options_.first_counter + measured_);
  out.status = options_.self_test_passed ? 1U : 0U;
  clip(sample.specific_force, kAccelerationRange, 8, out.status);
  clip(sample.rate, kRateRange, 11, out.status);
  if (outputs_.empty()) {
    fill_legacy(sample, out);
  } else {
    const auto ticks = static_cast<std::int64_t>(std::llround(seconds * kTicksPerSecond));
    out.ticks =
        static_cast<std::uint32_t>((options_.first_ticks + ticks) % drivers::kXsensDayTicks);
    fill_mtdata2(sample, out);
  }
  if (measured_++ == 0 && !ordered_) {
    const auto wake_up = drivers::encode_message(XsensMessage::kWakeUp);
    out.frame.insert(out.frame.begin(), wake_up.begin(), wake_up.end());
  }
  return out;
}

void XsensMti::fill_mtdata2(const Measurement& sample, MtiMessage& out) const {
  drivers::MtData2Writer writer;
  for (const XsensOutput& output : outputs_) {
    switch (drivers::kind_of(output.data_id)) {
      case XsensItem::kPacketCounter:
        writer.packet_counter(out.counter);
        break;
      case XsensItem::kSampleTimeFine:
        writer.sample_time_fine(out.ticks);
        break;
      case XsensItem::kStatusWord:
        writer.status_word(out.status);
        break;
      default: {
        const drivers::XsensNumberItem* const item = drivers::find_number_item(output.data_id);
        const auto every = static_cast<std::uint64_t>(rate_hz()) / output.rate_hz;
        if (item == nullptr || measured_ % every != 0) break;
        std::vector<double> numbers;
        for (const std::string_view channel : item->channels) {
          numbers.push_back(value_in_unit(sample, channel, item->unit));
          out.values.emplace_back(channel, numbers.back());
        }
        writer.numbers(item->item, drivers::format_of(output.data_id), numbers);
      }
    }
  }
  out.frame = drivers::encode_message(XsensMessage::kMtData2, writer.payload());
}

void XsensMti::fill_legacy(const Measurement& sample, MtiMessage& out) const {
  std::vector<double> numbers;
  for (const drivers::LegacyChannel& channel : drivers::channels_of(legacy_.layout)) {
    numbers.push_back(value_in_unit(sample, channel.name, channel.unit));
    out.values.emplace_back(channel.name, numbers.back());
  }
  out.frame = drivers::encode_message(
      XsensMessage::kMtData,
      drivers::encode_legacy(legacy_.layout, numbers, static_cast<std::uint8_t>(out.status),
                             out.counter, {}));
}

}  // namespace imunoise::emulator
