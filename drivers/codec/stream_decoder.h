#pragma once

#include <cstdint>

#include "drivers/codec/bytes.h"
#include "drivers/codec/refusal.h"
#include "drivers/codec/sample.h"

namespace imunoise::drivers {

/// What became of the bytes so far.
struct Tally {
  std::uint64_t samples = 0;
  std::uint64_t lost = 0;            ///< Samples that the device's counter says are missing.
  std::uint64_t other_messages = 0;  ///< Whole messages that carry no samples: acknowledgements.
  Refusals refused;
};

/// Bytes of one device in, samples out; whatever the pieces in which the bytes arrive, the samples
/// are the same. Memory: one message and what was pushed but not asked for. One thread at a time.
class StreamDecoder {
 public:
  virtual ~StreamDecoder() = default;
  StreamDecoder(const StreamDecoder&) = delete;
  StreamDecoder& operator=(const StreamDecoder&) = delete;

  virtual void push(Bytes bytes) = 0;
  /// There are no more bytes: what is still open is judged by the next calls of next().
  virtual void finish() = 0;
  /// Fills `sample` with the next one; false when more bytes are needed.
  virtual bool next(DecodedSample& sample) = 0;

  const Tally& tally() const { return tally_; }

 protected:
  StreamDecoder() = default;
  Tally tally_;
};

}  // namespace imunoise::drivers
