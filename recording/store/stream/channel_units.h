#pragma once

// What the numbers of a recorded channel mean.

#include <string>

#include "core/support/units.h"
#include "imunoise/v1/recording.pb.h"

namespace imunoise::recording {

/// Values in SI units are offset + scale · number. Of an unknown unit: in the channel's own.
struct ChannelUnits {
  Quantity quantity = Quantity::kUnknown;
  std::string symbol;  ///< Of the values.
  double scale = 1.0;
  double offset = 0.0;

  double value(double number) const { return offset + scale * number; }
};

inline ChannelUnits units_of(const v1::RecordedChannel& channel) {
  ChannelUnits out;
  out.scale = channel.has_scale_factor() ? channel.scale_factor() : 1.0;
  out.offset = channel.add_offset();
  out.symbol = channel.units();
  const auto unit = parse_unit(channel.units());
  if (!unit || unit->quantity == Quantity::kUnknown) return out;
  out.quantity = unit->quantity;
  out.symbol = std::string(si_symbol(unit->quantity));
  out.scale *= unit->to_si;
  out.offset = out.offset * unit->to_si + unit->si_offset;
  return out;
}

}  // namespace imunoise::recording
