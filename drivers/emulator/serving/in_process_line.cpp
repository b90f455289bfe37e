#include <stdlib.h>

#include <cerrno>
#include <filesystem>
#include <system_error>
#include <utility>

#include "drivers/can/codec/presets.h"
#include "drivers/can/device.h"
#include "drivers/emulator/serving/in_process.h"
#include "drivers/emulator/serving/serve.h"
#include "drivers/plugin/or_throw.h"
#include "drivers/xsens/device.h"

namespace imunoise::emulator {
namespace {

// A place for a link or socket; gone with it.
class PrivateFolder {
 public:
  PrivateFolder() {
    std::string pattern = (std::filesystem::temp_directory_path() / "imunoise-XXXXXX").string();
    if (::mkdtemp(pattern.data()) == nullptr) {
      throw std::system_error(errno, std::generic_category(), pattern);
    }
    path_ = pattern;
  }
  PrivateFolder(const PrivateFolder&) = delete;
  PrivateFolder& operator=(const PrivateFolder&) = delete;
  ~PrivateFolder() {
    std::error_code ignored;
    std::filesystem::remove_all(path_, ignored);
  }
  std::string file(const std::string& name) const { return (path_ / name).string(); }

 private:
  std::filesystem::path path_;
};

class EmulatedOnLine final : public plugin::Device {
 public:
  EmulatedOnLine(const InProcessPlan& plan, const plugin::Host& host) : serial_(plan.serial) {
    const bool can = plan.driver == "can";
    if (can && serial_.empty()) serial_ = "EMULATED";  // not the place, which is new each time
    const std::string place = (can ? "unix:" : "") + folder_.file(plan.driver);
    served_ = plugin::or_throw(serve({.driver = plan.driver,
                                      .place = place,
                                      .source = plan.source,
                                      .faults = plan.faults,
                                      .preset = plan.preset}));
    if (can) {
      device_ = std::make_unique<imunoise::can::CanDevice>(
          imunoise::can::Settings{.interface = place,
                                  .channels = plugin::or_throw(drivers::make_preset(plan.preset)),
                                  .product = plan.preset,
                                  .rate_hz = plan.source.rate.value},
          host);
    } else {
      xsens::Settings settings;
      settings.port = "pty:" + place;
      settings.rate_hz = static_cast<std::uint16_t>(plan.source.rate.value);
      device_ = std::make_unique<xsens::XsensDevice>(std::move(settings), host);
    }
  }

  drivers::DeviceInfo describe() override {
    drivers::DeviceInfo out = device_->describe();
    out.product += " (emulated)";
    if (!serial_.empty()) out.serial = serial_;
    return out;
  }
  void read(plugin::Samples& samples, const plugin::Wait& wait) override {
    device_->read(samples, wait);
  }
  void interrupt() noexcept override { device_->interrupt(); }

 private:
  std::string serial_;
  PrivateFolder folder_;
  std::unique_ptr<ServedDevice> served_;
  std::unique_ptr<plugin::Device> device_;  // last: it listens to the others
};

}  // namespace

std::unique_ptr<plugin::Device> open_on_line(const InProcessPlan& plan, const plugin::Host& host) {
  return std::make_unique<EmulatedOnLine>(plan, host);
}

}  // namespace imunoise::emulator
