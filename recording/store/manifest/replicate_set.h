#pragma once

// A set of replicates as ranges: as short for a thousand in a row as for one.

#include <cstdint>

#include "imunoise/v1/recording.pb.h"

namespace imunoise::recording {

/// In order, apart from one another, each from a first to a last replicate, both inclusive.
using ReplicateRanges = google::protobuf::RepeatedPtrField<v1::ReplicateRange>;

bool holds(const ReplicateRanges& ranges, std::uint32_t replicate);
void insert(ReplicateRanges& ranges, std::uint32_t replicate);
void erase(ReplicateRanges& ranges, std::uint32_t replicate);

/// Whether the ranges are in order and apart, and hold no more than `most` replicates.
bool is_replicate_set(const ReplicateRanges& ranges, std::uint64_t most);

}  // namespace imunoise::recording
