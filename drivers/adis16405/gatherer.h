#pragma once

// Samples from bursts that may be torn: where nothing waits for data-ready, the sensor may renew
// its outputs in the middle of a burst.

#include <cstddef>
#include <cstdint>
#include <optional>

#include "drivers/adis16405/codec/burst.h"

namespace imunoise::drivers::adis16405 {

/// What a burst came to for the channels of one stream.
enum class Gathered {
  kSample,      ///< All channels are new in it, or it completes the burst before it.
  kNothingNew,  ///< None is.
  kPart,        ///< Some are, and may be the first part of a sample.
};

/// Puts the words of one sample together. The sensor clears a word's ND bit when it is read, so a
/// sample that came while a burst was read has its later words new in that burst and the others,
/// and only those, in the next. No word is used twice, none is kept past the next burst that holds
/// anything new.
class Gatherer {
 public:
  /// `channels`: a set of channels as in burst.h; the others are not looked at.
  explicit Gatherer(std::uint16_t channels) : channels_(channels) {}

  Gathered take(const Burst& burst);
  /// The sample, after kSample: `counts` of its channels are good.
  const Burst& sample() const { return sample_; }
  /// Parts that were given up because their other words never came; counted since the last call.
  std::size_t take_lost();

 private:
  void give_up();

  std::uint16_t channels_;
  std::optional<Burst> part_;
  Burst sample_;
  std::size_t lost_ = 0;
};

}  // namespace imunoise::drivers::adis16405
