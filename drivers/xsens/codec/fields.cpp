#include "drivers/xsens/codec/fields.h"

#include <array>
#include <chrono>

#include "drivers/codec/si_unit.h"

namespace imunoise::drivers {
namespace {

struct StatusBit {
  unsigned bit;
  std::string_view word;
};

constexpr std::array kStatusBits = {
    StatusBit{0, "self_test_passed"}, StatusBit{1, "filter_valid"}, StatusBit{2, "gnss_fix"},
    StatusBit{8, "clip_acc_x"},       StatusBit{9, "clip_acc_y"},   StatusBit{10, "clip_acc_z"},
    StatusBit{11, "clip_gyro_x"},     StatusBit{12, "clip_gyro_y"}, StatusBit{13, "clip_gyro_z"},
    StatusBit{14, "clip_mag_x"},      StatusBit{15, "clip_mag_y"},  StatusBit{16, "clip_mag_z"},
    StatusBit{19, "clip_any"},        StatusBit{21, "sync_in"},
};

}  // namespace

XsensUtc take_utc(BigEndianReader& in) {
  XsensUtc out;
  out.nanosecond = in.take<std::uint32_t>();
  out.year = in.take<std::uint16_t>();
  out.month = in.take<std::uint8_t>();
  out.day = in.take<std::uint8_t>();
  out.hour = in.take<std::uint8_t>();
  out.minute = in.take<std::uint8_t>();
  out.second = in.take<std::uint8_t>();
  out.flags = in.take<std::uint8_t>();
  return out;
}

void append_utc(std::vector<std::uint8_t>& out, const XsensUtc& utc) {
  append_big_endian(out, utc.nanosecond);
  append_big_endian(out, utc.year);
  for (const std::uint8_t byte :
       {utc.month, utc.day, utc.hour, utc.minute, utc.second, utc.flags}) {
    out.push_back(byte);
  }
}

std::optional<double> unix_seconds(const XsensUtc& utc) {
  namespace chr = std::chrono;
  const chr::year_month_day date{chr::year(utc.year), chr::month(utc.month), chr::day(utc.day)};
  // Second 60 is a leap second.
  if (!date.ok() || utc.hour > 23 || utc.minute > 59 || utc.second > 60 ||
      utc.nanosecond >= 1'000'000'000) {
    return std::nullopt;
  }
  const auto whole = chr::sys_days(date) + chr::hours(utc.hour) + chr::minutes(utc.minute) +
                     chr::seconds(utc.second);
  return static_cast<double>(whole.time_since_epoch().count()) + 1e-9 * utc.nanosecond;
}

void append_utc_value(DecodedSample& sample, const XsensUtc& utc, Refusals& refused) {
  static const SiUnit kSecond = si_unit("s");
  if (const auto seconds = unix_seconds(utc)) {
    append_value(sample, "utc", kSecond, *seconds, refused);
  } else {
    refused.add(Refusal::kOutOfRange);
  }
}

void append_status_flags(std::uint32_t status, std::vector<std::string_view>& flags) {
  for (const StatusBit& known : kStatusBits) {
    if ((status >> known.bit & 1U) != 0) flags.push_back(known.word);
  }
}

}  // namespace imunoise::drivers
