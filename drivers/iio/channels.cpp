#include "drivers/iio/channels.h"

#include <array>

namespace imunoise::iio {
namespace {

struct Kind {
  std::string_view prefix;  // of the kernel's name
  std::string_view name;
  std::string_view unit;
  double unit_scale;  // units of ours per unit of the kernel's
  bool inertial;
};

constexpr std::array kKinds = {
    Kind{"anglvel", "gyro", "rad/s", 1.0, true}, Kind{"accel", "acc", "m/s^2", 1.0, true},
    Kind{"magn", "mag", "gauss", 1.0, true}, Kind{"temp", "temperature", "degC", 1e-3, false},
    Kind{"pressure", "pressure", "Pa", 1e3, false}};

const Kind* kind_of(std::string_view id) {
  for (const Kind& kind : kKinds) {
    if (id.starts_with(kind.prefix)) return &kind;
  }
  return nullptr;
}

drivers::NumberType type_of(const ScanChannel& channel) {
  const unsigned bits =
      channel.bits + (channel.is_signed ? 0 : 1);  // of a signed number that holds it
  if (bits <= 16) return drivers::NumberType::kInt16;
  return bits <= 32 ? drivers::NumberType::kInt32 : drivers::NumberType::kInt64;
}

}  // namespace

bool is_inertial(std::string_view id) {
  const Kind* const kind = kind_of(id);
  return kind != nullptr && kind->inertial;
}

drivers::Channel describe_channel(const ScanChannel& channel) {
  drivers::Channel out{channel.id, "1", type_of(channel), channel.scale,
                       channel.offset * channel.scale};
  if (const Kind* const kind = kind_of(channel.id)) {
    const std::string rest = channel.id.substr(kind->prefix.size());
    out.name = std::string(kind->name) + (rest == "0" ? "" : rest);
    out.units = kind->unit;
    out.scale_factor *= kind->unit_scale;
    out.add_offset *= kind->unit_scale;
  }
  return out;
}

}  // namespace imunoise::iio
