#include "tests/drivers/host/pretend_driver.h"

#include <utility>

#include "drivers/host/check.h"
#include "drivers/host/services.h"

namespace imunoise::testing {
namespace {

// What the next device that is opened shall do.
Pretend& next() {
  static Pretend pretend;
  return pretend;
}

class PretendDevice : public plugin::Device {
 public:
  explicit PretendDevice(Pretend pretend) : pretend_(std::move(pretend)) {}
  drivers::DeviceInfo describe() override { return pretend_.info; }
  void read(plugin::Samples& samples, const plugin::Wait& wait) override {
    pretend_.read(samples, wait);
  }
  void interrupt() noexcept override {
    if (pretend_.interrupt) pretend_.interrupt();
  }

 private:
  Pretend pretend_;
};

drivers::DriverInfo describe_driver() { return {"pretend", "For tests", "1", {}}; }

std::unique_ptr<plugin::Device> open_device(const plugin::Options& /*options*/,
                                            const plugin::Host& host) {
  if (next().opening) next().opening(host);
  return std::make_unique<PretendDevice>(next());
}

}  // namespace
}  // namespace imunoise::testing

IMUNOISE_DRIVER(imunoise::testing::describe_driver, imunoise::testing::open_device)

namespace imunoise::testing {

Result<std::unique_ptr<drivers::Device>> open(Pretend pretend, drivers::NoteHandler note,
                                              std::stop_token stop) {
  next() = std::move(pretend);
  const imunoise_driver* const table =
      imunoise_driver_entry(IMUNOISE_DRIVER_ABI, &drivers::host_services());
  const Result<drivers::DriverInfo> info = drivers::check_driver(table);
  if (!info) return tl::make_unexpected(info.error());
  return drivers::Device::open({*info, "inside the test", table}, {}, std::move(note), {},
                               std::move(stop));
}

}  // namespace imunoise::testing
