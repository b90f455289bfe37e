#pragma once

// What the user states about files that are imported.

#include <cstddef>
#include <optional>
#include <string>
#include <vector>

#include "core/support/units.h"

namespace imunoise::recording {

/// A replicate with fewer samples has nothing to say about noise.
inline constexpr std::size_t kMinimumSamples = 16;

/// The unit of the channels whose name matches.
struct UnitRule {
  std::string pattern;  ///< '*' and '?' are wildcards; names of the file or common ones (gyro_x)
  Unit unit;
};

/// Seconds after the first sample.
struct TimeSpan {
  double begin = 0.0;
  double end = 0.0;
};

/// What the user states about the files. Everything left out is taken from the files.
struct ImportOptions {
  /// Names of the channels wanted, in this order. Empty: every channel of the first file.
  std::vector<std::string> channels;
  /// Those, and every other channel that the files have; an unknown unit is then that of a
  /// number as it is, and what counts ticks is left out. Of a recording's folder: that share their
  /// clock (of the first stream where none is named), and what the device's other streams say at
  /// the same times.
  bool beside = false;
  /// One channel of each axis of motion beside those wanted, for the preflight to judge them by;
  /// it takes them out of the table again.
  bool axes_to_judge = false;
  /// Of what stands beside: only these, by name. Empty: all.
  std::vector<std::string> witnesses;
  /// Sampling rate. Wins over what a file states; a time column is then ignored, gaps included.
  std::optional<Hertz> rate;
  /// Units of channels. They win over what a file states; the first pattern that matches counts.
  std::vector<UnitRule> units;
  /// Seconds per number of the time column. Wins over what a file states.
  std::optional<double> time_unit;
  /// Uses only samples from this time on (s after the first sample of each file).
  std::optional<double> from;
  /// Uses only samples before this time.
  std::optional<double> until;
  /// Leaves these times out.
  std::vector<TimeSpan> exclude;
  /// Uses times in which the sensor was disturbed, too.
  bool use_disturbed = false;
  /// Uses times in which every axis repeats its readings, too.
  bool use_frozen = false;
  /// Refuses a file where the preflight would leave samples out or has doubts.
  bool strict = false;
  /// The topic of a bag. Empty: the only one that holds messages of an IMU.
  std::string topic;
  /// What the messages of a log of a CAN bus mean: a DBC file, or the name of a known IMU. Empty:
  /// unknown.
  std::string dbc;
  /// What separates the values of a text file; ' ' stands for any run of blanks. Unset: detected.
  std::optional<char> delimiter;
  /// Whether the first row of a text file names its columns. Unset: detected.
  std::optional<bool> header;
  /// Cuts every file into this many replicates of equal length, in order; the remainder at the end
  /// of the file (fewer than split_into samples) is left out. At least 1.
  std::size_t split_into = 1;
};

}  // namespace imunoise::recording
