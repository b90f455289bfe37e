#pragma once

// A driver inside the test program, made with drivers/plugin.h: its device does what a test says.

#include <functional>
#include <memory>

#include "drivers/host/device.h"
#include "drivers/plugin.h"

namespace imunoise::testing {

struct Pretend {
  drivers::DeviceInfo info;
  std::function<void(plugin::Samples&, const plugin::Wait&)> read;
  std::function<void(const plugin::Host&)> opening = {};
  std::function<void()> interrupt = {};
};

/// Opens a device that does this, through the C interface and the host.
Result<std::unique_ptr<drivers::Device>> open(Pretend pretend, drivers::NoteHandler note = {},
                                              std::stop_token stop = {});

}  // namespace imunoise::testing
