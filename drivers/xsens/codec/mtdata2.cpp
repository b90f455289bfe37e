#include "drivers/xsens/codec/mtdata2.h"

#include <algorithm>
#include <array>
#include <cassert>

#include "drivers/xsens/codec/gnss.h"

namespace imunoise::drivers {
namespace {

void decode_numbers(const XsensNumberItem& item, const XsensItemData& data, MtData2& out,
                    Refusals& refused) {
  const XsensFormat format = format_of(data.id);
  XsensItemNumbers& numbers = out.items.emplace_back();
  numbers = {data.id, out.numbers.size(), 0};
  if (data.data.size() != item.channels.size() * size_of(format)) {
    return refused.add(Refusal::kLength);
  }
  numbers.count = item.channels.size();
  DecodedSample& sample = out.sample;
  BigEndianReader in(data.data);
  for (const std::string_view channel : item.channels) {
    out.numbers.push_back(take_number(in, format));
    append_value(sample, channel, item.si, out.numbers.back(), refused);
  }
  constexpr std::array<std::string_view, 4> kFrames = {"", "ned", "nwu", "unknown_frame"};
  const std::string_view frame = kFrames[data.id >> 2U & 3U];
  auto& flags = sample.flags;
  if (item.framed && !frame.empty() &&
      std::find(flags.begin(), flags.end(), frame) == flags.end()) {
    flags.push_back(frame);
  }
}

// An item that is one unsigned number.
template <std::unsigned_integral T>
std::optional<T> whole(Bytes data, Refusals& refused) {
  if (data.size() != sizeof(T)) {
    refused.add(Refusal::kLength);
    return std::nullopt;
  }
  return BigEndianReader(data).take<T>();
}

void decode_item(const XsensItemData& item, MtData2& out, Refusals& refused) {
  DecodedSample& sample = out.sample;
  switch (kind_of(item.id)) {
    case XsensItem::kPacketCounter:
      if (const auto count = whole<std::uint16_t>(item.data, refused)) out.packet_counter = count;
      return;
    case XsensItem::kSampleTimeFine:
      if (const auto ticks = whole<std::uint32_t>(item.data, refused)) out.sample_time_fine = ticks;
      return;
    case XsensItem::kSampleTimeCoarse:
      if (const auto seconds = whole<std::uint32_t>(item.data, refused)) {
        sample.values.push_back({"sample_time_coarse", "s", static_cast<double>(*seconds)});
      }
      return;
    case XsensItem::kUtcTime: {
      BigEndianReader in(item.data);
      const XsensUtc utc = take_utc(in);
      if (!in.ok() || in.left() > 0) return refused.add(Refusal::kLength);
      return append_utc_value(sample, utc, refused);
    }
    case XsensItem::kPressure:
      if (const auto pascal = whole<std::uint32_t>(item.data, refused)) {
        sample.values.push_back({"pressure", "Pa", static_cast<double>(*pascal)});
      }
      return;
    case XsensItem::kStatusByte:
      if (const auto status = whole<std::uint8_t>(item.data, refused)) {
        out.status = *status;
        append_status_flags(*status, sample.flags);
      }
      return;
    case XsensItem::kStatusWord:
      if (const auto status = whole<std::uint32_t>(item.data, refused)) {
        out.status = *status;
        append_status_flags(*status, sample.flags);
      }
      return;
    case XsensItem::kGnssSolution:
      sample.stream = "gnss";
      return append_gnss_solution(sample, item.data, refused);
    case XsensItem::kGnssSatellites:
      sample.stream = "gnss";
      return append_gnss_satellites(sample, item.data, refused);
    default:
      if (const XsensNumberItem* const numbers = find_number_item(item.id)) {
        return decode_numbers(*numbers, item, out, refused);
      }
      refused.add(Refusal::kUnknownItem);
  }
}

}  // namespace

std::optional<XsensItemData> take_item(Bytes& payload) {
  BigEndianReader in(payload);
  const auto id = in.take<std::uint16_t>();
  const Bytes data = in.take_bytes(in.take<std::uint8_t>());
  if (!in.ok()) return std::nullopt;
  payload = payload.last(in.left());
  return XsensItemData{id, data};
}

void decode_mtdata2(Bytes payload, MtData2& out, Refusals& refused) {
  out.packet_counter.reset();
  out.sample_time_fine.reset();
  out.status.reset();
  out.sample.clear();
  out.sample.stream = "imu";
  out.items.clear();
  out.numbers.clear();
  while (const auto item = take_item(payload)) decode_item(*item, out, refused);
  if (!payload.empty()) refused.add(Refusal::kLength);
}

void MtData2Writer::header(std::uint16_t id, std::size_t bytes) {
  assert(bytes <= 255);
  append_big_endian(payload_, id);
  payload_.push_back(static_cast<std::uint8_t>(bytes));
}

void MtData2Writer::packet_counter(std::uint16_t count) {
  header(static_cast<std::uint16_t>(XsensItem::kPacketCounter), sizeof count);
  append_big_endian(payload_, count);
}

void MtData2Writer::sample_time_fine(std::uint32_t ticks) {
  header(static_cast<std::uint16_t>(XsensItem::kSampleTimeFine), sizeof ticks);
  append_big_endian(payload_, ticks);
}

void MtData2Writer::utc(const XsensUtc& utc) {
  header(static_cast<std::uint16_t>(XsensItem::kUtcTime), 12);
  append_utc(payload_, utc);
}

void MtData2Writer::status_word(std::uint32_t status) {
  header(static_cast<std::uint16_t>(XsensItem::kStatusWord), sizeof status);
  append_big_endian(payload_, status);
}

void MtData2Writer::pressure(std::uint32_t pascal) {
  header(static_cast<std::uint16_t>(XsensItem::kPressure), sizeof pascal);
  append_big_endian(payload_, pascal);
}

void MtData2Writer::numbers(XsensItem item, XsensFormat format, std::span<const double> values) {
  header(id_of(item, format), values.size() * size_of(format));
  for (const double value : values) append_number(payload_, format, value);
}

void MtData2Writer::raw(std::uint16_t id, Bytes data) {
  header(id, data.size());
  payload_.insert(payload_.end(), data.begin(), data.end());
}

}  // namespace imunoise::drivers
