#pragma once

// What is known of one device while it is recorded.

#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include "daemon/live/concern.h"
#include "daemon/live/live_variance.h"
#include "daemon/live/recent_rate.h"
#include "daemon/live/sample_rings.h"
#include "daemon/live/trouble.h"
#include "imunoise/v1/live.pb.h"
#include "imunoise/v1/service.pb.h"
#include "recording/store/stream/channel_units.h"
#include "recording/store/stream/stream.h"

namespace imunoise::live {

/// Wavelet variances of its angular rates and accelerations, and what is of concern. Not
/// thread-safe.
class LiveDevice {
 public:
  explicit LiveDevice(const v1::RecordedDevice& device);

  /// Samples as they are recorded: check_block() accepted them.
  void take(const recording::Block& block, Steady::time_point now = Steady::now());
  v1::LiveDevice state(Steady::time_point now = Steady::now()) const;
  /// What state() warns of.
  std::vector<v1::LiveWarning> warnings(Steady::time_point now = Steady::now()) const;
  /// The latest samples of a stream (empty: the first), as SampleRings gives them. Error: also a
  /// stream that it has not.
  Result<v1::SampleRanges> samples(const v1::GetLiveSamplesRequest& request) const;
  const std::string& name() const { return device_.name(); }

 private:
  struct Channel {
    std::size_t index = 0;  // in the stream
    LiveVariance variance;
    double last = 0.0;  // number, and since when it has been the same
    std::int64_t same_since_ns = 0;
    Concern saturated;
  };
  struct Warmth {
    std::size_t index = 0;
    recording::ChannelUnits units;  // K
    Slope slope;
    std::optional<double> newest;  // K
  };
  struct Stream {
    explicit Stream(const v1::RecordedStream& stream) : rings(stream) {}
    SampleRings rings;
    RecentRate rate;
    std::vector<Channel> channels;
    std::vector<Warmth> warmths;
    std::uint64_t samples = 0;
    std::uint64_t refused = 0;
    std::uint64_t gaps = 0;
    std::uint64_t missing = 0;
    std::optional<std::int64_t> begin_ns;
    std::int64_t now_ns = 0;
    Steady::time_point heard;  // when the newest samples came
    Concern rejected;
    Concern lost;  // missing before a row
  };
  // What a picture of the device shows.
  struct Pictured {
    std::size_t stream = 0;
    std::size_t channel = 0;  // in the stream
  };
  static std::optional<Pictured> pictured_of(const v1::RecordedDevice& device);
  void take_channel(const recording::Rows& rows, const v1::RecordedStream& stream, Channel& to);
  static void take_gaps(const recording::Rows& rows, double rate_hz, Stream& to);
  static double silence(const v1::RecordedStream& stream, const Stream& of, Steady::time_point now);
  static v1::LiveStream describe(const v1::RecordedStream& stream, const Stream& of,
                                 Steady::time_point now);
  static v1::LiveChannel describe(const v1::RecordedStream& stream, const Channel& channel);
  static void warn(const v1::RecordedStream& stream, const Stream& of, Steady::time_point now,
                   std::vector<v1::LiveWarning>& to);

  v1::LiveWarning past_warning() const;

  v1::RecordedDevice device_;
  std::vector<Stream> streams_;
  std::optional<Pictured> pictured_;
};

}  // namespace imunoise::live
