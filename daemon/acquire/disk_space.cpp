#include "daemon/acquire/disk_space.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "daemon/config/quantity_text.h"
#include "recording/store/journal/journal.h"

namespace imunoise::acquire {
namespace {

using config::print_bytes;
using config::print_duration;

constexpr std::size_t kFlags = sizeof(std::uint32_t);

std::size_t number_bytes(const std::string& dtype) {
  const auto numbers = recording::numbers_of_type(dtype);
  if (!numbers) return sizeof(double);
  return std::visit([]<class Number>(const std::vector<Number>&) { return sizeof(Number); },
                    *numbers);
}

}  // namespace

double bytes_per_second(const v1::RecordedDevice& device) {
  double out = 0.0;
  for (const v1::RecordedStream& stream : device.streams()) {
    std::size_t row = sizeof(std::int64_t) + kFlags;
    if (stream.counter_modulus() > 0) row += sizeof(std::int64_t);
    for (const v1::RecordedChannel& channel : stream.channels()) {
      row += number_bytes(channel.dtype());
    }
    out += stream.rate_hz() * static_cast<double>(row);
  }
  return out;
}

Result<void> check_room(const DiskPlan& plan, std::uint64_t free) {
  double rate = 0.0;
  for (const v1::RecordedDevice& device : plan.devices) rate += bytes_per_second(device);
  // While a segment becomes a chunk, both are there.
  const double segments = static_cast<double>(plan.devices.size()) *
                          static_cast<double>(recording::SegmentLimits{}.bytes);
  const double needed = rate * plan.seconds + std::min(segments, rate * plan.seconds);
  const double room = static_cast<double>(free) - static_cast<double>(plan.reserve_bytes);
  if (needed <= room) return {};
  const std::string until =
      room <= 0.0 || rate <= 0.0
          ? "the reserve is already in use"
          : fmt::format("it would be reached in {}", print_duration(std::floor(room / rate)));
  return fail(
      fmt::format("{} may be needed; the disk has {} free, and {} must stay free: "
                  "{}; free some space, "
                  "or record less",
                  print_bytes(needed), print_bytes(static_cast<double>(free)),
                  print_bytes(static_cast<double>(plan.reserve_bytes)), until));
}

}  // namespace imunoise::acquire
