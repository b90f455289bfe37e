#pragma once

#include <cstdint>
#include <functional>
#include <span>
#include <string_view>

namespace imunoise::drivers {

/// What a driver tells of a device, for people. Called from any thread; must be thread-safe, and
/// must not call the device.
using NoteHandler = std::function<void(std::string_view text)>;

/// Bytes as they came over a device's wire, one call after the other, from opening it on; must not
/// call the device.
using WireHandler = std::function<void(std::span<const std::uint8_t> bytes)>;

}  // namespace imunoise::drivers
