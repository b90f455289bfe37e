#include "recording/store/timeline/device_clock.h"

#include <cmath>
#include <utility>

namespace imunoise::recording {
namespace {

constexpr std::int64_t kClockWindow = 1'000'000'000;  // ns
constexpr std::size_t kFewestWindows = 10;            // windows
constexpr double kNormal95 = 1.959963984540054;

}  // namespace

void DeviceClock::take(std::span<const std::int64_t> host_ns,
                       std::span<const std::int64_t> device_ns) {
  Stretch& s = now_;
  for (std::size_t i = 0; i < host_ns.size(); ++i) {
    const std::int64_t delay = host_ns[i] - device_ns[i];
    if (s.all.points() == 0) {
      s.device_origin_ns = device_ns[i];
      s.delay_origin_ns = delay;
    }
    const std::int64_t since = device_ns[i] - s.device_origin_ns;
    const double x = static_cast<double>(since) * 1e-9;
    const double y = static_cast<double>(delay - s.delay_origin_ns) * 1e-9;
    s.all.add(x, y);
    const std::int64_t window = since / kClockWindow;
    if (window != s.window && s.window >= 0) s.earliest.add(s.window_x, s.window_y);
    if (window != s.window || y < s.window_y) {
      s.window_x = x;
      s.window_y = y;
    }
    s.window = window;
  }
}

void DeviceClock::restart() {
  best_ = longest();
  now_ = {};
}

const DeviceClock::Stretch& DeviceClock::longest() const {
  return now_.earliest.points() >= best_.earliest.points() ? now_ : best_;
}

std::optional<v1::ClockComparison> DeviceClock::comparison() const {
  const Stretch& s = longest();
  if (s.earliest.points() < kFewestWindows) return std::nullopt;
  const double error = kNormal95 * s.earliest.slope_error();
  v1::ClockComparison out;
  // A fast device counts more seconds than the host: the host falls behind it.
  out.set_ppm(-1e6 * s.earliest.slope());
  out.set_ppm_lower(out.ppm() - 1e6 * error);
  out.set_ppm_upper(out.ppm() + 1e6 * error);
  out.set_first_sample_ns(s.device_origin_ns + s.delay_origin_ns +
                          std::llround(1e9 * s.earliest.at(0.0)));
  out.set_jitter_s(s.all.standard_deviation());
  out.set_seconds(static_cast<double>(s.earliest.points()));
  return out;
}

}  // namespace imunoise::recording
