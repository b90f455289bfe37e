// A device of a simulated month, for tests: 100 samples a second of its own time, which runs
// `speed` times as fast as the clock, each with its number since the device was switched on as
// value. Between good samples some are damaged on the wire (refused) and some lost on it (its
// counter jumps); now and then it is unplugged, and samples on. All from one seed.

#include <chrono>
#include <random>
#include <string>

#include "core/support/random.h"
#include "drivers/plugin.h"

namespace imunoise::testing {
namespace {

using Clock = std::chrono::steady_clock;

constexpr std::chrono::milliseconds kPeriod{2};
constexpr std::int64_t kSampleNs = 10'000'000;

class Month : public plugin::Device {
 public:
  Month(const plugin::Options& options, const plugin::Host& host)
      : host_(host),
        random_(static_cast<std::uint64_t>(options.integer("seed"))),
        batch_(options.integer("speed") * kPeriod.count() / 10),
        time_ns_(host.now_ns()),
        next_(Clock::now()) {}

  drivers::DeviceInfo describe() override {
    drivers::Stream stream{"imu",
                           {{.name = "number", .units = "1", .type = drivers::NumberType::kInt64}},
                           100.0,
                           65'535};
    return {{stream}, "Month", "1", "1"};
  }

  void read(plugin::Samples& samples, const plugin::Wait& wait) override {
    if (!wait.until(next_)) return;
    next_ += kPeriod;
    if (happens(5e-4)) {  // until it is plugged in again
      next_ += 20 * kPeriod;
      skip(20 * batch_);
      throw plugin::DeviceError(IMUNOISE_DISCONNECTED, "unplugged");
    }
    const bool damaged = happens(0.02);
    const bool lost = happens(0.02);
    for (std::int64_t k = 0; k < batch_; ++k) {
      // Never at the ends of what comes at once, so that every fault lies between good samples.
      if (k == batch_ / 3 && lost)
        skip(1 + static_cast<std::int64_t>(uniform_(random_.engine()) * 300.0));
      if (k == batch_ / 2 && damaged) {
        const auto count = 1 + static_cast<std::int64_t>(uniform_(random_.engine()) * 5.0);
        samples.refuse(0, plugin::Reason::kChecksum, static_cast<std::uint64_t>(count));
        skip(count);
      }
      samples
          .add(0,
               {.host_time_ns = time_ns_, .counter = static_cast<std::uint64_t>(number_ % 65'536)})
          .set(0, number_);
      skip(1);
    }
  }

 private:
  bool happens(double probability) { return uniform_(random_.engine()) < probability; }
  void skip(std::int64_t count) {
    number_ += count;
    time_ns_ += count * kSampleNs;
  }

  plugin::Host host_;
  RandomStream random_;
  std::uniform_real_distribution<double> uniform_{0.0, 1.0};
  std::int64_t batch_;
  std::int64_t time_ns_;
  std::int64_t number_ = 0;
  Clock::time_point next_;
};

drivers::DriverInfo describe_driver() {
  return {"month",
          "A device of a simulated month",
          "1",
          {{.name = "seed",
            .type = drivers::OptionType::kInteger,
            .description = "Of its faults",
            .required = true,
            .minimum = 0},
           {.name = "speed",
            .type = drivers::OptionType::kInteger,
            .description = "Times real time",
            .required = true,
            .minimum = 5}}};
}

std::unique_ptr<plugin::Device> open_device(const plugin::Options& options,
                                            const plugin::Host& host) {
  return std::make_unique<Month>(options, host);
}

}  // namespace
}  // namespace imunoise::testing

IMUNOISE_DRIVER(imunoise::testing::describe_driver, imunoise::testing::open_device)
