// A device that does as a file tells it, for tests: the file's word is looked at whenever the
// device is opened or read. "here": a sample of noise every 10 ms; "gone": it is unplugged, and
// found again as soon as the word is another; "broken": it fails for good; "absent": it does not
// open; "deaf": its opening waits for as long as it may; "other": as "here", but opened then it is
// another device; "knock": as "here", a hundred times as loud; "rateless": as "here", opened then
// its stream has no rate; "silent": nothing comes any more; "stubborn": the same, and it hears no
// cancel for 300 ms at a time; "over": it has nothing more to say.
// With speed=20 twenty samples come instead of one, and its time runs as fast; with stamped=true
// they carry the host's time.

#include <chrono>
#include <fstream>
#include <string>
#include <thread>

#include "core/support/random.h"
#include "drivers/plugin.h"

namespace imunoise::testing {
namespace {

using Clock = std::chrono::steady_clock;
constexpr std::chrono::milliseconds kPeriod{10};
constexpr std::chrono::milliseconds kStubborn{300};

std::string word_in(const std::string& file) {
  std::ifstream stream(file);
  std::string out;
  stream >> out;
  return out;
}

class Whims : public plugin::Device {
 public:
  Whims(const plugin::Options& options, const plugin::Host& host)
      : host_(host),
        file_(options.text("file")),
        speed_(options.integer("speed")),
        stamped_(options.flag("stamped")),
        time_ns_(host.now_ns()),
        next_(Clock::now()) {
    const std::string word = word_in(file_);
    if (word == "absent") throw plugin::DeviceError(IMUNOISE_NOT_FOUND, "the device is absent");
    if (word == "deaf") wait_in_vain(host);
    serial_ = word == "other" ? "2" : "1";
    rate_hz_ = word == "rateless" ? 0.0 : 100.0;
  }

  drivers::DeviceInfo describe() override {
    drivers::Stream stream{"imu", {{.name = "gyro_x", .units = "rad/s"}}, rate_hz_, 255};
    return {{stream}, "Whims", serial_, "1"};
  }

  void read(plugin::Samples& samples, const plugin::Wait& wait) override {
    const std::string word = word_in(file_);
    if (word == "broken") throw plugin::DeviceError(IMUNOISE_FAILED, "the device is broken");
    if (word == "gone") {
      wait.until(Clock::now() + kPeriod);
      next_ = Clock::now();
      throw plugin::DeviceError(IMUNOISE_DISCONNECTED, "the device is disconnected");
    }
    if (word == "over") return samples.end();
    if (word == "stubborn") return std::this_thread::sleep_for(kStubborn);
    if (!wait.until(next_)) return;
    next_ += kPeriod;
    if (word == "silent") return;
    const double loud = word == "knock" ? 100.0 : 1.0;
    for (std::int64_t k = 0; k < speed_; ++k) {
      time_ns_ = stamped_ ? host_.now_ns() : time_ns_ + std::chrono::nanoseconds(kPeriod).count();
      samples.add(0, {.host_time_ns = time_ns_, .counter = counter_++ % 256})
          .set(0, loud * random_.normal());
    }
  }

 private:
  static void wait_in_vain(const plugin::Host& host) {
    const plugin::Wait wait(host.opening(), std::chrono::hours(1));
    wait.until(wait.deadline());
    throw plugin::DeviceError(IMUNOISE_CANCELLED, "the device is deaf");
  }

  plugin::Host host_;
  std::string file_;
  std::int64_t speed_;
  bool stamped_;
  std::int64_t time_ns_;  // of the last sample
  std::uint64_t counter_ = 0;
  std::string serial_;
  double rate_hz_ = 0.0;
  RandomStream random_{7};
  Clock::time_point next_;
};

drivers::DriverInfo describe_driver() {
  return {"whims",
          "A device that does as a file tells it",
          "1",
          {{.name = "file",
            .type = drivers::OptionType::kText,
            .description = "Holds the word",
            .required = true},
           {.name = "speed",
            .type = drivers::OptionType::kInteger,
            .description = "Times real time",
            .by_default = "1",
            .minimum = 1},
           {.name = "stamped",
            .type = drivers::OptionType::kFlag,
            .description = "Samples carry the host's time",
            .by_default = "false"}}};
}

std::unique_ptr<plugin::Device> open_device(const plugin::Options& options,
                                            const plugin::Host& host) {
  return std::make_unique<Whims>(options, host);
}

}  // namespace
}  // namespace imunoise::testing

IMUNOISE_DRIVER(imunoise::testing::describe_driver, imunoise::testing::open_device)
