#pragma once

#include <memory>

#include "drivers/plugin.h"
#include "drivers/replay/pace.h"
#include "drivers/replay/wire/codec.h"

namespace imunoise::replay {

/// Captured bytes as the device that sent them. Host times are those of the capture, or of the
/// device's rate where it has none, and begin with the replay.
class WireDevice final : public plugin::Device {
 public:
  WireDevice(std::unique_ptr<WireCodec> codec, Pace pace, const plugin::Host& host)
      : codec_(std::move(codec)), timeline_(pace, host), next_ns_(codec_->next()) {
    for (const std::string& note : codec_->notes()) host.note(note);
  }

  drivers::DeviceInfo describe() override { return codec_->info(); }
  void read(plugin::Samples& samples, const plugin::Wait& wait) override;

 private:
  std::unique_ptr<WireCodec> codec_;
  Timeline timeline_;
  std::optional<std::int64_t> next_ns_;  // time of the next message
};

}  // namespace imunoise::replay
