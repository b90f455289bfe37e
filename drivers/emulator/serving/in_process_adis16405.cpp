#include <chrono>
#include <cmath>
#include <optional>
#include <utility>

#include "drivers/adis16405/device.h"
#include "drivers/emulator/faults/fault_text.h"
#include "drivers/emulator/sensors/adis16405.h"
#include "drivers/emulator/serving/in_process.h"
#include "drivers/emulator/usb/ft232h.h"
#include "drivers/emulator/usb/usb_bus.h"
#include "drivers/plugin/or_throw.h"

namespace imunoise::emulator {
namespace {

using drivers::adis16405::Adis16405Device;
using drivers::adis16405::Choice;
using Clock = plugin::Wait::Clock;

// The sensor's time is its bus's; it is read when it is due.
class EmulatedAdis16405 final : public plugin::Device {
 public:
  EmulatedAdis16405(const InProcessPlan& plan, Choice choice, std::vector<Fault> faults,
                    const plugin::Host& host)
      : source_(plugin::or_throw(ModelledSource::make(plan.source))),
        sensor_(*source_, plan.source.seed, Memory::kNone),
        bridge_(sensor_, plan.serial.empty() ? "EMULATED" : plan.serial),
        begin_ns_(host.now_ns()),
        begin_(Clock::now()),
        bus_(std::make_shared<EmulatedBus>(bridge_, begin_ns_)),
        speed_(plan.speed),
        rate_hz_(plan.source.rate.value),
        length_(plan.length_s ? Time(std::llround(*plan.length_s * 1e9)) : kNever),
        faults_(std::move(faults)),
        device_(bus_, std::move(choice), host) {}

  drivers::DeviceInfo describe() override {
    drivers::DeviceInfo out = device_.describe();
    out.product += " (emulated)";
    return out;
  }

  void read(plugin::Samples& samples, const plugin::Wait& wait) override {
    if (plugged_in_at_ && Clock::now() >= *plugged_in_at_) {
      bus_->plug(seconds(unplugged_for_));
      plugged_in_at_.reset();
    }
    go_wrong();
    if (!end_) end_ = passed() + length_;  // what it took to start does not count
    if (passed() >= *end_) return samples.end();
    if (!plugged_in_at_ && speed_ > 0.0 && !wait.until(due())) return;
    device_.read(samples, wait);
  }

 private:
  static constexpr Time kNever = std::chrono::years(100);

  Time seconds(std::uint64_t samples) const {
    return Time(static_cast<std::int64_t>(static_cast<double>(samples) / rate_hz_ * 1e9));
  }
  // Of the emulated time, since the device was opened.
  Time passed() const { return Time(bus_->host_time_ns(bridge_.now()) - begin_ns_); }
  // When the host's clock shows what the emulated one does.
  Clock::time_point due() const { return begin_ + real_time(passed()); }
  Time real_time(Time emulated) const {
    if (speed_ == 0.0) return Time(0);
    return Time(std::llround(static_cast<double>(emulated.count()) / speed_));
  }
  // Every fault happens once, at the first read behind its sample.
  void go_wrong() {
    std::erase_if(faults_, [this](const Fault& fault) {
      if (fault.sample > sensor_.samples()) return false;
      happen(fault);
      return true;
    });
  }
  void happen(const Fault& fault) {
    switch (fault.kind) {
      case Fault::Kind::kStall:  // until the driver resets it
        sensor_.faults.stalled = true;
        break;
      case Fault::Kind::kLate:
        bus_->hold_up(seconds(fault.count));
        break;
      case Fault::Kind::kUnplug:
        bus_->unplug();
        unplugged_for_ = fault.count;
        plugged_in_at_ = Clock::now() + real_time(seconds(fault.count));
        break;
      case Fault::Kind::kLoss:
        bus_->lose_byte();
        break;
      case Fault::Kind::kBitError:  // refused by open_adis16405()
        break;
    }
  }

  std::unique_ptr<ModelledSource> source_;
  Adis16405 sensor_;
  Ft232h bridge_;
  std::int64_t begin_ns_;
  Clock::time_point begin_;
  std::shared_ptr<EmulatedBus> bus_;
  double speed_;
  double rate_hz_;
  Time length_;
  std::optional<Time> end_;
  std::vector<Fault> faults_;
  std::uint64_t unplugged_for_ = 0;  // samples
  std::optional<Clock::time_point> plugged_in_at_;
  Adis16405Device device_;
};

}  // namespace

std::unique_ptr<plugin::Device> open_adis16405(const InProcessPlan& plan,
                                               const plugin::Host& host) {
  auto faults = plugin::or_throw(parse_faults(plan.faults));
  for (const Fault& fault : faults) {
    if (fault.kind != Fault::Kind::kBitError) continue;
    throw plugin::DeviceError(
        IMUNOISE_BAD_OPTION,
        "bit_error: bursts of an ADIS16405 carry no checksum, so that a wrong "
        "bit is a wrong sample; use outliers() instead");
  }
  Choice choice;
  choice.settings.sample_period =
      plugin::or_throw(drivers::adis16405::sample_period(plan.source.rate));
  return std::make_unique<EmulatedAdis16405>(plan, std::move(choice), std::move(faults), host);
}

}  // namespace imunoise::emulator
