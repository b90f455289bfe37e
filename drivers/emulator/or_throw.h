#pragma once

#include <utility>

#include "core/support/result.h"
#include "drivers/plugin/device.h"

namespace imunoise::emulator {

/// What a user's option came to, or the end of opening the device.
template <class T>
T or_throw(Result<T> result) {
  if (!result) throw plugin::DeviceError(IMUNOISE_BAD_OPTION, result.error().message);
  return std::move(*result);
}

}  // namespace imunoise::emulator
