#pragma once

// Channels of several devices as one array's replicates.

#include <cstdint>
#include <string>
#include <vector>

#include "core/support/progress.h"
#include "recording/import/table/channel.h"
#include "recording/store/disk/file_system.h"

namespace imunoise::recording {

/// A stream beside those of other devices.
struct JoinedStream {
  std::string device;
  std::string stream;
  Hertz rate;                 ///< Nominal.
  double clock_ppm = 0.0;     ///< 1e-6: how much faster it samples, by the host's clock.
  double seconds = 0.0;       ///< s, that it recorded: alone or together.
  std::size_t averaged = 1;   ///< Consecutive samples that make one.
  std::uint64_t dropped = 0;  ///< Samples left out to keep step with the slowest.
};

/// A stream that stands beside no other, and why.
struct LeftOut {
  std::string device;
  std::string stream;
  std::string reason;
};

struct Across {
  /// Of the replicates, stream after stream. Where there are none, all that were to be joined.
  std::vector<std::string> channels;
  std::vector<JoinedStream> streams;
  std::vector<LeftOut> left_out;
  double seconds = 0.0;               ///< s, of all replicates together.
  std::vector<Replicate> replicates;  ///< Empty unless two devices are joined.
};

/// Reads channels of several devices, aligned by the host's clock as common_grid() says. Their rate
/// is the nominal one of the slowest; streams whose rate is a whole multiple of it (to 0.1 %) are
/// averaged over as many samples as that. Each stretch that all share without a gap is a replicate,
/// named as by import_recording(); lengths that differ by less than 1 % are cut to the shortest.
///
/// One for each rate that several devices go with, and at least one: first the rate that most go
/// with (of equals the highest), which leaves the others out. Left out, too, with the reason: a
/// stream that is not sound; without ten seconds in one piece; with a clock more than 3 % off its
/// nominal rate; without time in common with the others, or with less than half of what two or more
/// others have together. Streams that recorded longest are joined first.
///
/// `channels` as import_recording() calls them. Memory: these channels in all replicates, twice.
/// Error: no recording, a channel that it has not, an unknown unit, no two devices, nothing long
/// enough, a stop.
Result<std::vector<Across>> import_across(const FileSystem& files,
                                          const std::filesystem::path& root,
                                          const std::vector<std::string>& channels,
                                          const Progress& progress = {});

}  // namespace imunoise::recording
