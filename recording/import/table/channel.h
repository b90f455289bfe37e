#pragma once

// What an import yields: replicates, each a set of channels that share one rate and one length.

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <filesystem>
#include <memory>
#include <string>
#include <variant>
#include <vector>

#include "core/signal/signal.h"
#include "core/support/units.h"
#include "recording/import/table/findings.h"

namespace imunoise::recording {

/// Numbers as the file stores them: counts stay integers, every float becomes a double.
using Samples =
    std::variant<std::vector<double>, std::vector<std::int16_t>, std::vector<std::int32_t>>;

/// How many numbers there are.
inline std::size_t size(const Samples& samples) {
  return std::visit([](const auto& values) { return values.size(); }, samples);
}

/// One measured axis. Copies and parts of a recording share the samples. Thread-safe to read.
struct Channel {
  std::string name;
  std::shared_ptr<const Samples> samples;  ///< Of the whole file; never null after an import.
  std::size_t begin = 0;                   ///< First sample of this channel in `samples`.
  std::size_t count = 0;                   ///< Samples of this channel.
  double scale = 1.0;                      ///< SI units per stored number.
  double offset = 0.0;                     ///< SI units: value_SI = offset + scale · sample.
  Unit unit;                               ///< As the file (or the user) states it.
  Hertz rate;
  /// Its samples lie between those that another clock made: a witness, never a subject.
  bool interpolated = false;

  /// The channel as the mathematics sees it. Borrows: keep this channel (or a copy) alive.
  Signal signal() const {
    return std::visit(
        [this](const auto& values) {
          const auto whole = std::span(values);
          return Signal(whole.subspan(begin, count), rate, unit.quantity, scale, offset);
        },
        *samples);
  }
};

/// What counters and clocks showed of a replicate's samples.
struct Timing {
  std::size_t gaps = 0;    ///< places where the recording was cut; of the first part between gaps
  std::uint64_t lost = 0;  ///< samples lost there, as far as that is known
  double jitter = 0.0;     ///< rms departure of stamps from even spacing, in periods; 0: none known
};

/// Where a replicate lies in what was recorded: a recording that is cut makes several. They follow
/// each other, unless its clock started anew.
struct Origin {
  std::size_t recording = 0;  ///< its number among the recordings of an import, from 0
  std::uint64_t first = 0;    ///< samples, lost ones too, from its first to the replicate's first
};

/// The origin of what begins so many samples after the first of a recording: by a clock, which may
/// be damaged.
inline Origin origin_at(std::size_t recording, double samples) {
  constexpr double kFarthest = 1e15;
  if (!std::isfinite(samples)) return {recording, 0};
  return {recording, static_cast<std::uint64_t>(std::clamp(std::round(samples), 0.0, kFarthest))};
}

/// One uninterrupted static recording of a sensor.
struct Replicate {
  std::string name;  ///< For messages and plots; unique within an import.
  std::filesystem::path source;
  Hertz rate;
  std::vector<Channel> channels;  ///< All of the same length.
  Timing timing{};
  std::shared_ptr<const Preflight> preflight{};  ///< of the file; null for a recording
  Origin origin{};
};

}  // namespace imunoise::recording
