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

/// Puts them into a report; into each channel's report, where it is a list of them.
template <class Report>
void add_preflight(std::span<const recording::Replicate> replicates, Report& to) {
  if constexpr (requires { to.mutable_preflight(); }) {
    *to.mutable_preflight() = preflights(replicates);
  } else {
    for (auto& one : *to.mutable_channels()) add_preflight(replicates, one);
  }
}

}  // namespace imunoise::study
