#include "recording/store/timeline/timeline.h"

#include <cmath>
#include <span>

#include "recording/store/timeline/device_clock.h"

namespace imunoise::recording {
namespace {

// The device's clock counts its samples at the nominal rate.
std::vector<std::int64_t> nominal_times(std::size_t count, double rate_hz) {
  std::vector<std::int64_t> out(count);
  for (std::size_t i = 0; i < count; ++i) {
    out[i] = std::llround(static_cast<double>(i) / rate_hz * 1e9);
  }
  return out;
}

}  // namespace

std::vector<Timeline> timelines(const v1::RecordedStream& stream, const Rows& rows) {
  std::vector<Timeline> out;
  for (const Part& part : parts_between(find_gaps(stream, rows), rows.size())) {
    DeviceClock clock;
    clock.take(std::span(rows.host_time).subspan(part.begin, part.count),
               nominal_times(part.count, stream.rate_hz()));
    const auto found = clock.comparison();
    if (!found) continue;
    out.push_back(
        {part, found->first_sample_ns(), (1.0 - 1e-6 * found->ppm()) * 1e9 / stream.rate_hz()});
  }
  return out;
}

}  // namespace imunoise::recording
