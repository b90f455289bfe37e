#include "daemon/acquire/open_devices.h"

#include <fmt/format.h>

#include <algorithm>
#include <thread>
#include <utility>

namespace imunoise::acquire {
namespace {

using Steady = std::chrono::steady_clock;

constexpr std::chrono::milliseconds kBetween{1000};  // attempts
constexpr std::chrono::milliseconds kSlice{10};      // after which stopping is seen

void wait(std::chrono::duration<double> time, const Progress& progress) {
  const Steady::time_point begin = Steady::now();
  while (Steady::now() - begin < time && !progress.stopped()) std::this_thread::sleep_for(kSlice);
}

}  // namespace

Result<std::unique_ptr<drivers::Device>> open_device(const DevicePlan& plan, const DeviceNote& note,
                                                     drivers::WireHandler wire,
                                                     std::stop_token stop) {
  auto device = drivers::Device::open(
      plan.driver, plan.options,
      [note, name = plan.name](std::string_view text) {
        if (note) note(name, text);
      },
      std::move(wire), std::move(stop));
  if (!device) return fail(fmt::format("{}: {}", plan.name, device.error().message));
  return device;
}

Result<OpenDevices> open_devices(
    const std::vector<DevicePlan>& plans,
    const std::function<Result<std::unique_ptr<drivers::Device>>(std::size_t)>& open,
    std::optional<std::chrono::duration<double>> patience, const Progress& progress) {
  const Steady::time_point begin = Steady::now();
  OpenDevices out;
  out.devices.resize(plans.size());
  while (true) {
    out.missing.clear();
    for (std::size_t i = 0; i < plans.size() && !progress.stopped(); ++i) {
      if (out.devices[i]) continue;
      auto device = open(i);
      if (device) {
        out.devices[i] = std::move(*device);
        continue;
      }
      if (!patience) return tl::make_unexpected(device.error());
      v1::MissingDevice& missing = out.missing.emplace_back();
      missing.set_device(plans[i].name);
      missing.set_reason(device.error().message);
    }
    if (progress.stopped()) return fail(kStoppedOpening);
    if (out.missing.empty()) return out;
    const std::chrono::duration<double> left = *patience - (Steady::now() - begin);
    if (left <= std::chrono::duration<double>::zero()) break;
    wait(std::min<std::chrono::duration<double>>(left, kBetween), progress);
  }
  if (out.missing.size() < plans.size()) return out;
  return fail(fmt::format("no device answers: {}", out.missing.front().reason()));
}

}  // namespace imunoise::acquire
