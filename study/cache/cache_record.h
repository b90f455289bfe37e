#pragma once

// What is known of a channel, as a file keeps it.

#include <optional>

#include "study/analysis/prepared_channel.h"
#include "study/cache/cache_file.h"

namespace imunoise::study {

/// A channel without its witnesses; the key is left empty.
CacheFile record_of(const PreparedChannel& prepared);
/// A witness, recorded at this rate.
CacheFile record_of(const Witness& witness, Hertz rate);

/// What a file was made of; nothing where it does not hang together. Shares the file's arrays.
std::optional<PreparedChannel> channel_of(const CacheFile& file);
std::optional<Witness> witness_of(const CacheFile& file);

}  // namespace imunoise::study
