#include "drivers/emulator/serving/serve.h"

#include <fmt/format.h>

#include <system_error>
#include <utility>

#include "drivers/can/codec/presets.h"
#include "drivers/emulator/faults/fault_text.h"
#include "drivers/emulator/sensors/can_imu.h"
#include "drivers/emulator/sensors/xsens_on_pty.h"

namespace imunoise::emulator {
namespace {

using Source = std::unique_ptr<ModelledSource>;

MtiOptions mti_options(bool fourth_generation) {
  MtiOptions out;
  out.fourth_generation = fourth_generation;
  if (!fourth_generation) out.product = "MTi-G-28A53G35";
  return out;
}

class ServedMti final : public ServedDevice {
 public:
  ServedMti(const ServePlan& plan, Source source, std::vector<Fault> faults)
      : place_(plan.place),
        source_(std::move(source)),
        device_(mti_options(plan.fourth_generation), *source_, std::move(faults), plan.place,
                Memory::kNone) {}

  std::string device_text() const override { return "xsens port=pty:" + place_; }
  std::size_t messages() const override { return device_.messages(); }

 private:
  std::string place_;
  Source source_;
  XsensOnPty device_;
};

std::unique_ptr<CanLine> make_line(const std::string& place) {
  constexpr std::string_view kLocal = "unix:";
  if (!place.starts_with(kLocal)) return std::make_unique<SocketCanLine>(place);
  return std::make_unique<LocalCanLine>(place.substr(kLocal.size()));
}

class ServedCan final : public ServedDevice {
 public:
  ServedCan(const ServePlan& plan, drivers::CanChannels channels, Source source,
            std::vector<Fault> faults)
      : text_(fmt::format("can interface={} preset={}", plan.place, plan.preset)),
        source_(std::move(source)),
        line_(make_line(plan.place)),
        device_(std::move(channels), plan.source.rate.value, *source_, *line_, std::move(faults),
                Memory::kNone) {}

  std::string device_text() const override { return text_; }
  std::size_t messages() const override { return device_.frames(); }

 private:
  std::string text_;
  Source source_;
  std::unique_ptr<CanLine> line_;
  CanImu device_;
};

}  // namespace

Result<std::unique_ptr<ServedDevice>> serve(const ServePlan& plan) {
  auto source = ModelledSource::make(plan.source);
  if (!source) return tl::make_unexpected(source.error());
  auto faults = parse_faults(plan.faults);
  if (!faults) return tl::make_unexpected(faults.error());
  try {
    if (plan.driver == "xsens") {
      return std::make_unique<ServedMti>(plan, std::move(*source), std::move(*faults));
    }
    if (plan.driver == "can") {
      auto channels = drivers::make_preset(plan.preset);
      if (!channels) return tl::make_unexpected(channels.error());
      return std::make_unique<ServedCan>(plan, std::move(*channels), std::move(*source),
                                         std::move(*faults));
    }
  } catch (const std::exception& error) {
    return fail(fmt::format(
        "{}: cannot be served ({}); see that the place is free and may be written{}", plan.place,
        error.what(), plan.driver == "can" ? "; without CAN in the kernel, take unix:PATH" : ""));
  }
  return fail(fmt::format(
      "{}: cannot be served to other programs; emulate it where it is recorded: imunoise record "
      "FOLDER --device \"emulated device={}\"",
      plan.driver, plan.driver));
}

}  // namespace imunoise::emulator
