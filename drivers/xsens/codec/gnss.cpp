#include "drivers/xsens/codec/gnss.h"

#include <array>
#include <string_view>

#include "drivers/xsens/codec/field.h"

namespace imunoise::drivers {
namespace {

using Kind = XsensField::Kind;
using Field = XsensField;

constexpr std::array kSolution = {
    Field{Kind::kU32, "gnss_time_of_week", "s", 1e-3},
    // date, time of day, their validity, its accuracy and the nanosecond: item 0x1010 says them too
    Field{Kind::kU16, "", ""},
    Field{Kind::kU8, "", ""},
    Field{Kind::kU8, "", ""},
    Field{Kind::kU8, "", ""},
    Field{Kind::kU8, "", ""},
    Field{Kind::kU8, "", ""},
    Field{Kind::kU8, "", ""},
    Field{Kind::kU32, "gnss_time_accuracy", "s", 1e-9},
    Field{Kind::kI32, "", ""},
    Field{Kind::kU8, "gnss_fix_type", "1"},
    Field{Kind::kU8, "", ""},  // flags
    Field{Kind::kU8, "gnss_satellites_used", "1"},
    Field{Kind::kU8, "", ""},  // reserved
    Field{Kind::kI32, "gnss_longitude", "deg", 1e-7},
    Field{Kind::kI32, "gnss_latitude", "deg", 1e-7},
    Field{Kind::kI32, "gnss_height", "m", 1e-3},
    Field{Kind::kI32, "gnss_height_above_sea", "m", 1e-3},
    Field{Kind::kU32, "gnss_horizontal_accuracy", "m", 1e-3},
    Field{Kind::kU32, "gnss_vertical_accuracy", "m", 1e-3},
    Field{Kind::kI32, "gnss_velocity_north", "m/s", 1e-3},
    Field{Kind::kI32, "gnss_velocity_east", "m/s", 1e-3},
    Field{Kind::kI32, "gnss_velocity_down", "m/s", 1e-3},
    Field{Kind::kI32, "gnss_ground_speed", "m/s", 1e-3},
    Field{Kind::kI32, "gnss_heading_of_motion", "deg", 1e-5},
    Field{Kind::kU32, "gnss_speed_accuracy", "m/s", 1e-3},
    Field{Kind::kU32, "gnss_heading_accuracy", "deg", 1e-5},
    Field{Kind::kI32, "gnss_heading_of_vehicle", "deg", 1e-5},
    Field{Kind::kU16, "gnss_geometric_dop", "1", 0.01},
    Field{Kind::kU16, "gnss_position_dop", "1", 0.01},
    Field{Kind::kU16, "gnss_time_dop", "1", 0.01},
    Field{Kind::kU16, "gnss_vertical_dop", "1", 0.01},
    Field{Kind::kU16, "gnss_horizontal_dop", "1", 0.01},
    Field{Kind::kU16, "gnss_northing_dop", "1", 0.01},
    Field{Kind::kU16, "gnss_easting_dop", "1", 0.01},
};

constexpr std::size_t kSolutionBytes = [] {
  std::size_t out = 0;
  for (const Field& field : kSolution) out += bytes_of(field.kind);
  return out;
}();
static_assert(kSolutionBytes == 94);

}  // namespace

void append_gnss_solution(DecodedSample& sample, Bytes data, Refusals& refused) {
  if (data.size() != kSolutionBytes) return refused.add(Refusal::kLength);
  BigEndianReader in(data);
  for (const Field& field : kSolution) {
    const double number = take_whole(in, field.kind);
    if (!field.channel.empty()) {
      sample.values.push_back({field.channel, field.unit, number * field.scale});
    }
  }
}

void append_gnss_satellites(DecodedSample& sample, Bytes data, Refusals& refused) {
  constexpr std::size_t kHead = 8;
  constexpr std::size_t kEach = 4;
  if (data.size() < kHead || data.size() != kHead + kEach * data[4]) {
    return refused.add(Refusal::kLength);
  }
  sample.values.push_back({"gnss_satellites_seen", "1", static_cast<double>(data[4])});
}

}  // namespace imunoise::drivers
