#pragma once

// What is known of a channel, as a file keeps it.

#include <optional>

#include "study/analysis/seen_channel.h"
#include "study/seen/seen_file.h"

namespace imunoise::study {

/// A channel without its witnesses; the key is left empty.
SeenFile record_of(const SeenChannel& seen);
/// A witness, recorded at this rate.
SeenFile record_of(const Witness& witness, Hertz rate);

/// What a file was made of; nothing where it does not hang together. Shares the file's arrays.
std::optional<SeenChannel> channel_of(const SeenFile& file);
std::optional<Witness> witness_of(const SeenFile& file);

}  // namespace imunoise::study
