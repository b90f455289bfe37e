#pragma once

#include <google/protobuf/repeated_ptr_field.h>

#include <span>

#include "imunoise/v1/preflight.pb.h"
#include "recording/import/table/channel.h"

namespace imunoise::study {

/// What was recognised in the files of replicates, and what is wrong with them: one a file, in
/// order. None for recordings of imunoise's own.
google::protobuf::RepeatedPtrField<v1::Preflight> preflights(
    std::span<const recording::Replicate> replicates);

}  // namespace imunoise::study
