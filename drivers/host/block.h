#pragma once

// Samples of one stream, as a read delivers them.

#include <cassert>
#include <cstddef>
#include <cstdint>
#include <memory>
#include <span>
#include <vector>

#include "drivers/description.h"

namespace imunoise::drivers {

/// Buffers that a device fills and that are used again and again. Movable. Not thread-safe.
class SampleBlock {
 public:
  /// Room for `rows` samples (at least 1) of any stream of the device.
  SampleBlock(std::shared_ptr<const DeviceInfo> device, std::size_t rows);
  SampleBlock(SampleBlock&&) noexcept = default;
  SampleBlock& operator=(SampleBlock&&) noexcept = default;

  /// Samples there are; may be 0 where all were refused.
  std::size_t rows() const { return table_->rows; }
  /// Whose samples they are: index in DeviceInfo::streams.
  std::size_t stream_index() const { return table_->stream; }
  const Stream& stream() const { return device_->streams[table_->stream]; }

  /// When each sample was taken or came, ns since 1970-01-01 UTC.
  std::span<const std::int64_t> host_time_ns() const { return rows_of(host_time_ns_); }
  /// Device's clock, any origin, ns. No meaning where the stream has no device_time_tick_s.
  std::span<const std::int64_t> device_time_ns() const { return rows_of(device_time_ns_); }
  /// Device's sample counter. No meaning where the stream has no counter_maximum.
  std::span<const std::uint64_t> counter() const { return rows_of(counter_); }
  /// IMUNOISE_SAMPLE_SATURATED and its like.
  std::span<const std::uint32_t> flags() const { return rows_of(flags_); }

  /// Numbers of a channel; `Number` must be its type.
  template <class Number>
  std::span<const Number> column(std::size_t channel) const {
    assert(stream().channels[channel].type == number_type<Number>());
    return {static_cast<const Number*>(columns_[channel]), rows()};
  }

  /// Samples of this stream refused since the last block, by reason (IMUNOISE_REFUSED_...) and
  /// channel.
  std::uint64_t refused(std::size_t reason, std::size_t channel) const {
    return refused_[reason * columns_.size() + channel];
  }

 private:
  friend class Device;

  template <class Value>
  std::span<const Value> rows_of(const std::vector<Value>& values) const {
    return std::span(values).first(rows());
  }
  /// Empties it and returns the table that a driver fills.
  imunoise_block& prepare();
  bool any_refused() const;

  std::shared_ptr<const DeviceInfo> device_;
  std::vector<std::int64_t> host_time_ns_;
  std::vector<std::int64_t> device_time_ns_;
  std::vector<std::uint64_t> counter_;
  std::vector<std::uint32_t> flags_;
  std::vector<std::uint64_t> numbers_;  // 8 bytes a number, whatever its type: aligned for any
  std::vector<void*> columns_;
  std::vector<std::uint64_t> refused_;
  std::unique_ptr<imunoise_block> table_;  // does not move with the block: plugins may keep it
};

}  // namespace imunoise::drivers
