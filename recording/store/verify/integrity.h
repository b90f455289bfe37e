#pragma once

// What a recorded stream is worth: losses, duplicates, saturation, stuck codes, rate and jitter.

#include <vector>

#include "recording/store/timeline/gaps.h"

namespace imunoise::recording {

/// Counts, gaps and rates of a stream, for `imunoise verify`; replicate, device and in_journal are
/// left to the caller. A row that repeats its counter is a duplicate.
v1::StreamIntegrity check_stream(const v1::RecordedStream& stream, const Rows& rows);

/// Runs of one number in a channel. A run is *stuck* when it would come by chance in fewer than one
/// of a million recordings, were neighbours equal independently of one another: n pᴸ < 1e-6 with p
/// the share of equal neighbours outside the run, n samples, run length L.
v1::ChannelIntegrity check_channel(const v1::RecordedChannel& channel, const Numbers& numbers);

}  // namespace imunoise::recording
