#include "drivers/adis16405/codec/registers.h"

#include <fmt/format.h>

#include <algorithm>

namespace imunoise::drivers::adis16405 {
namespace {

constexpr double kFastBase = 0.61035e-3;  // s
constexpr double kSlowBase = 18.921e-3;   // s
constexpr std::uint16_t kSlowBit = 0x80;
constexpr std::uint16_t kLowPower = 0x0a;  // and above

struct Bit {
  unsigned bit;
  std::string_view word;
};

constexpr std::array kDiagnosis = {
    Bit{0, "supply_below_4.75_V"},
    Bit{1, "supply_above_5.25_V"},
    Bit{2, "flash_update_failed"},
    Bit{3, "spi_failed"},
    Bit{4, "overrange"},
    Bit{5, "self_test_failed"},
    Bit{6, "flash_test_failed"},
    Bit{8, "alarm_1"},
    Bit{9, "alarm_2"},
    Bit{10, "gyro_self_test_failed"},
    Bit{11, "gyro_self_test_failed"},
    Bit{12, "gyro_self_test_failed"},
    Bit{13, "acc_x_self_test_failed"},
    Bit{14, "acc_y_self_test_failed"},
    Bit{15, "acc_z_self_test_failed"},
};

}  // namespace

Hertz sample_rate(std::uint16_t sample_period) {
  const double base = (sample_period & kSlowBit) != 0 ? kSlowBase : kFastBase;
  return {1.0 / (base * ((sample_period & 0x7fU) + 1U))};
}

Hertz fastest_spi_clock(std::uint16_t sample_period) {
  return {(sample_period & 0xffU) < kLowPower ? 2e6 : 0.3e6};
}

Result<double> gyro_range(std::uint16_t sensitivity_averaging) {
  struct Range {
    unsigned code;
    double full_scale;
    unsigned least_filter;
  };
  constexpr std::array kRanges = {Range{4, 300.0, 0}, Range{2, 150.0, 2}, Range{1, 75.0, 4}};
  const unsigned bits = sensitivity_averaging;
  const unsigned code = bits >> 8U & 7U;
  const unsigned filter = bits & 7U;
  const auto* const found = std::find_if(kRanges.begin(), kRanges.end(),
                                         [&](const Range& range) { return range.code == code; });
  if (found == kRanges.end()) {
    return fail(
        fmt::format("ADIS16405: SENS_AVG 0x{:04X}: bits 10 to 8 name no range; use 4 "
                    "(300 °/s), 2 (150 °/s) or 1 (75 °/s), e.g. 0x0402",
                    sensitivity_averaging));
  }
  if (filter < found->least_filter) {
    return fail(
        fmt::format("ADIS16405: SENS_AVG 0x{:04X}: a range of {:g} °/s needs a filter (bits "
                    "2 to 0) of at least {}",
                    sensitivity_averaging, found->full_scale, found->least_filter));
  }
  return found->full_scale;
}

std::vector<std::string_view> diagnosis(std::uint16_t diagnostic_status) {
  std::vector<std::string_view> out;
  const unsigned bits = diagnostic_status;
  for (const Bit& known : kDiagnosis) {
    const bool set = (bits >> known.bit & 1U) != 0;
    if (set && (out.empty() || out.back() != known.word)) out.push_back(known.word);
  }
  return out;
}

}  // namespace imunoise::drivers::adis16405
