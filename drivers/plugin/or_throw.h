#pragma once

#include <utility>

#include "drivers/plugin/device.h"

namespace imunoise::plugin {

/// What an option came to, or the end of opening the device with its error's words. For results
/// like std::expected whose error has a `message`.
template <class Result>
typename Result::value_type or_throw(Result result) {
  if (!result) throw DeviceError(IMUNOISE_BAD_OPTION, result.error().message);
  return std::move(*result);
}

}  // namespace imunoise::plugin
