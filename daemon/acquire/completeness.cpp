#include "daemon/acquire/completeness.h"

#include <fmt/format.h>

#include <algorithm>

#include "daemon/config/quantity_text.h"

namespace imunoise::acquire {
namespace {

constexpr double kShare = 0.1;  // of the planned time, at its end
constexpr double kLeast = 1.0;  // s
constexpr double kMost = 5.0;   // s
constexpr double kSamples = 20.0;
constexpr double kAsMany = 0.99;        // of the samples that a device's nominal rate promises
constexpr double kLeastPresence = 0.9;  // of those before its end

struct Fastest {
  double rate_hz = 0.0;
  std::uint64_t stored = 0;
  std::uint64_t received = 0;
};

Fastest fastest_of(const DeviceCourse& course) {
  Fastest out;
  for (int i = 0; i < course.device.streams_size(); ++i) {
    const double rate = course.device.streams(i).rate_hz();
    const recording::StreamCounts& counts = course.counts[static_cast<std::size_t>(i)];
    if (rate > out.rate_hz) out = {rate, counts.stored, counts.received};
  }
  return out;
}

}  // namespace

std::string shortfall(const DeviceCourse& course, std::optional<double> planned_s) {
  if (course.discarded > 0) {
    return fmt::format(
        "device {}: {} samples were discarded, because its disk could not store them: {}",
        course.device.name(), course.discarded, course.disk);
  }
  if (!planned_s) return "";
  const Fastest fastest = fastest_of(course);
  const double expected = (*planned_s - course.from_s) * fastest.rate_hz;
  if (expected < (course.from_s > 0.0 ? kSamples : 1.0)) return "";
  const double tail =
      std::max(std::clamp(kShare * *planned_s, kLeast, kMost), kSamples / fastest.rate_hz);
  const bool to_the_end = course.last_s && *course.last_s >= *planned_s - tail;
  const auto stored = static_cast<double>(fastest.stored);
  if (fastest.stored > 0 && (to_the_end || stored >= kAsMany * expected)) {
    const double fewest = kLeastPresence * (expected - tail * fastest.rate_hz);
    if (static_cast<double>(fastest.received) >= fewest) return "";
    return fmt::format(
        "device {}: {} of about {:.0f} samples came in {}: it was away for a while, or is slower "
        "than the {} Hz that its driver says",
        course.device.name(), fastest.received, expected, config::print_duration(*planned_s),
        fastest.rate_hz);
  }
  const std::string when = course.last_s ? fmt::format("its last sample came {} after the start",
                                                       config::print_duration(*course.last_s))
                                         : "it sent no samples";
  return fmt::format("device {}: {}; {} of about {:.0f} samples in {} are stored",
                     course.device.name(), when, fastest.stored, expected,
                     config::print_duration(*planned_s));
}

}  // namespace imunoise::acquire
