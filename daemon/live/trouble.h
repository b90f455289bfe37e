#pragma once

// What keeps a running campaign from recording.

#include <chrono>
#include <optional>
#include <string>

#include "recording/store/recorder/recorder.h"

namespace imunoise::live {

using Steady = std::chrono::steady_clock;

/// A call of the disk that takes longer hangs, and so does a thread that does nothing for as long.
inline constexpr std::chrono::seconds kHangsAfter{5};

struct Trouble {
  std::string what;  ///< Names the thing and the place.
  Steady::time_point since;
  bool hangs = false;  ///< Nothing goes on. Otherwise it fails, and is tried again.
};

/// "... (since 2026-03-01 06:00:00 UTC)"
std::string sentence(const Trouble& trouble);

/// Of a call that should have returned long since.
std::optional<Trouble> trouble_of(const recording::DiskCall& call, Steady::time_point now);
/// Of the disk under one device.
std::optional<Trouble> trouble_of(const std::string& device, const recording::DeviceDisk& disk,
                                  Steady::time_point now);

}  // namespace imunoise::live
