// The driver "emulated": devices that are not there, read by their real drivers.

#include <cmath>
#include <map>
#include <memory>
#include <mutex>
#include <random>
#include <utility>

#include "drivers/can/codec/presets.h"
#include "drivers/emulator/serving/in_process.h"
#include "drivers/plugin.h"

namespace imunoise::emulator {
namespace {

drivers::DriverInfo describe_driver() {
  using enum drivers::OptionType;
  const auto presets = drivers::preset_names();
  return {
      "emulated",
      "An emulated ADIS16405, Xsens MTi or CAN IMU behind its real driver, with any noise model",
      IMUNOISE_VERSION,
      {
          {.name = "device",
           .type = kText,
           .description = "Device to emulate",
           .required = true,
           .choices = {"adis16405", "xsens", "can"}},
          {.name = "model",
           .type = kText,
           .description =
               "Noise, such as gyro:WN(sigma2=1e-6)+RW(gamma2=1e-12), per sample in SI; also "
               "acc, mag, one axis (gyro_x), temperature, supply (default: of a "
               "consumer's IMU)",
           .repeated = true},
          {.name = "effect",
           .type = kText,
           .description = "Effect, such as fan(frequency=23,amplitude=1e-3,channel=gyro_x); see "
                          "imunoise emulate "
                          "--help",
           .repeated = true},
          {.name = "fault",
           .type = kText,
           .description =
               "Fault, such as unplug(sample=500,count=100); see imunoise emulate --help",
           .repeated = true},
          {.name = "seed",
           .type = kInteger,
           .description = "Random seed; a reopened device continues with new values",
           .by_default = "1",
           .minimum = 0},
          {.name = "serial",
           .type = kText,
           .description = "Serial number (default: the same for all devices of a kind)"},
          {.name = "rate",
           .type = kNumber,
           .description = "Sampling rate (default: 102.4 for an adis16405, else 100)",
           .unit = "Hz",
           .minimum = 0.2,
           .maximum = 2000.0},
          {.name = "speed",
           .type = kNumber,
           .description = "adis16405: speed relative to real time; 0 is as fast as possible",
           .by_default = "1",
           .minimum = 0.0,
           .maximum = 1e6},
          {.name = "length",
           .type = kNumber,
           .description = "adis16405: length of the recording in its own time (default: unlimited)",
           .unit = "s",
           .minimum = 0.001,
           .maximum = 1e9},
          {.name = "preset",
           .type = kText,
           .description = "can: IMU to emulate",
           .by_default = "mti600",
           .choices = {presets.begin(), presets.end()}},
      },
  };
}

// Replicates of one recording are openings of one device: the first has the seed itself, each later
// one of this program a seed that follows from it.
std::uint64_t seed_of_opening(std::uint64_t seed) {
  static std::mutex mutex;
  static std::map<std::uint64_t, std::uint32_t> openings;
  const std::lock_guard lock(mutex);
  const std::uint32_t opening = openings[seed]++;
  if (opening == 0) return seed;
  std::seed_seq sequence{static_cast<std::uint32_t>(seed), static_cast<std::uint32_t>(seed >> 32U),
                         opening};
  return std::mt19937_64(sequence)();
}

[[noreturn]] void refuse(const std::string& text) {
  throw plugin::DeviceError(IMUNOISE_BAD_OPTION, text);
}

std::unique_ptr<plugin::Device> open_device(const plugin::Options& options,
                                            const plugin::Host& host) {
  InProcessPlan plan{.driver = options.text("device"), .source = {}, .faults = {}};
  const bool adis = plan.driver == "adis16405";
  plan.source.models = options.texts("model");
  plan.source.effects = options.texts("effect");
  plan.source.seed = seed_of_opening(static_cast<std::uint64_t>(options.integer("seed")));
  plan.source.rate = Hertz{adis ? 102.4 : 100.0};
  if (options.has("rate")) plan.source.rate = Hertz{options.number("rate")};
  plan.faults = options.texts("fault");
  plan.speed = options.number("speed");
  if (options.has("length")) plan.length_s = options.number("length");
  plan.preset = options.text("preset");
  if (options.has("serial")) plan.serial = options.text("serial");
  if (adis) return open_adis16405(plan, host);
  if (plan.speed != 1.0) {
    refuse("speed: an emulated " + plan.driver +
           " runs in real time; only an adis16405's time is "
           "emulated too");
  }
  if (plan.length_s) refuse("length: only an emulated adis16405 ends by itself");
  const double rate = plan.source.rate.value;
  if (plan.driver == "xsens" && (rate < 2.0 || rate != std::floor(rate))) {
    refuse("rate: an MTi's is a whole number from 2 Hz on");
  }
  return open_on_line(plan, host);
}

}  // namespace
}  // namespace imunoise::emulator

IMUNOISE_DRIVER(imunoise::emulator::describe_driver, imunoise::emulator::open_device)
