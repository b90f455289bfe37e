#pragma once

// From frames to the streams that they belong to.

#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include "core/support/result.h"
#include "drivers/can/codec/channels.h"
#include "drivers/can/streams.h"
#include "drivers/plugin/samples.h"

namespace imunoise::can {

/// The streams of some channels: first all that the database knows, then, once settle() has looked
/// at what came, those that are there. Borrows the channels. One thread at a time.
class FrameStreams {
 public:
  /// Error: as CanStream::all_of().
  static Result<FrameStreams> make(const drivers::CanChannels& channels);

  const std::vector<CanStream>& streams() const { return streams_; }
  std::vector<drivers::Stream> descriptions() const;

  /// Counts a frame, and when it came, for settle().
  void hear(const drivers::CanFrame& frame, std::int64_t time_ns);
  /// The first stream of which nothing was heard; null: none.
  const CanStream* missing() const;
  /// The first stream that was heard, but not often enough to tell its rate; null: none.
  const CanStream* without_rate() const;
  /// Forgets streams of which nothing was heard in `listened_s` s, and gives the others their
  /// rates: as they came, to three digits, or whole fractions of `rate_hz`, which is the fastest's.
  /// Returns those that were heard and whose rate nothing tells: they are forgotten too.
  std::vector<CanStream> settle(std::optional<double> rate_hz, double listened_s);

  /// Adds the samples of a frame.
  void take(const drivers::CanFrame& frame, std::int64_t time_ns, plugin::Samples& samples);
  /// The next sample of each stream carries these flags too.
  void mark(std::uint32_t flags);
  /// Counters begin anew.
  void restart();

 private:
  // When frames of a stream came, ns.
  struct Arrivals {
    std::vector<std::int64_t> times;

    double rate() const;
  };

  explicit FrameStreams(const drivers::CanChannels& channels) : channels_(&channels) {}
  // Fills present_ and calls visit(stream number) for every stream that the frame belongs to.
  template <class Visit>
  void for_streams_of(const drivers::CanFrame& frame, Visit visit);

  const drivers::CanChannels* channels_;
  std::vector<CanStream> streams_;
  std::vector<Arrivals> arrivals_;    // by stream
  std::vector<std::uint32_t> flags_;  // by stream, of its next sample
  std::vector<drivers::SignalValue> present_;
};

}  // namespace imunoise::can
