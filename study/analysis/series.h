#pragma once

// One channel over all its replicates: what a model is fitted to.

#include <span>
#include <string>
#include <vector>

#include "core/effect/subject.h"
#include "core/signal/signal.h"
#include "core/support/result.h"
#include "recording/import/table/channel.h"

namespace imunoise::study {

/// Borrows the samples of the replicates it was made from.
struct Series {
  std::string channel;
  std::vector<std::string> names;  ///< of the replicates
  std::vector<Signal> replicates;
  std::vector<NamedChannel> beside{};  ///< recorded with it: the witnesses that effects may follow
};

/// Channel number `channel` of every replicate, and the others beside it. Precondition: each has
/// that many channels.
Series series_of(std::span<const recording::Replicate> replicates, std::size_t channel);

/// The number of a channel, by its own name or a common one (gyro_x); a nameless one is the only
/// one. Error: there is none of that name; says
/// which there are.
Result<std::size_t> channel_called(const std::string& name, const recording::Replicate& in);

}  // namespace imunoise::study
