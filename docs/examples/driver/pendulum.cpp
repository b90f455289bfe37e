// A driver for a sensor that exists only here: a pendulum whose angle is sampled at an even rate.

#include <chrono>
#include <cmath>
#include <cstdint>
#include <memory>

#include "drivers/plugin.h"

using namespace imunoise;

namespace {

drivers::Stream stream_at(double rate_hz) {
  drivers::Stream out;
  out.name = "pendulum";
  out.nominal_rate_hz = rate_hz;
  out.counter_maximum = UINT32_MAX;
  out.channels = {
      {.name = "angle",
       .units = "rad",
       .type = drivers::NumberType::kInt16,
       .scale_factor = 1e-4,
       .long_name = "angle from the vertical"},
      {.name = "temperature", .units = "degC", .type = drivers::NumberType::kFloat32},
  };
  return out;
}

class Pendulum : public plugin::Device {
 public:
  Pendulum(double rate_hz, const plugin::Host& host)
      : rate_hz_(rate_hz), host_(host), start_(plugin::Wait::Clock::now()) {}

  drivers::DeviceInfo describe() override { return {{stream_at(rate_hz_)}, "pendulum", "no. 1"}; }

  void read(plugin::Samples& samples, const plugin::Wait& wait) override {
    using std::chrono::nanoseconds;
    const double seconds = static_cast<double>(next_) / rate_hz_;
    if (!wait.until(start_ + nanoseconds(std::llround(seconds * 1e9)))) return;
    const std::uint32_t counter = next_++;
    // Now and then this sensor sends the same bytes twice. They are counted, not delivered.
    if (counter % 100 == 99) return samples.refuse(0, plugin::Reason::kStale);
    plugin::Stamp stamp;
    stamp.host_time_ns = host_.now_ns();
    stamp.counter = counter;
    samples.add(0, stamp).set(0, std::lround(1000.0 * std::sin(3.0 * seconds))).set(1, 21.5);
  }

 private:
  double rate_hz_;
  plugin::Host host_;
  plugin::Wait::Clock::time_point start_;
  std::uint32_t next_ = 0;
};

drivers::DriverInfo describe_driver() {
  return {
      "pendulum",
      "A pendulum that exists only in the driver guide",
      "1.0",
      {{.name = "rate",
        .type = drivers::OptionType::kNumber,
        .description = "Sampling rate",
        .unit = "Hz",
        .by_default = "100",
        .minimum = 1.0,
        .maximum = 1000.0}},
      {stream_at(100.0)},
  };
}

std::unique_ptr<plugin::Device> open_device(const plugin::Options& options,
                                            const plugin::Host& host) {
  return std::make_unique<Pendulum>(options.number("rate"), host);
}

}  // namespace

IMUNOISE_DRIVER(describe_driver, open_device)
