#pragma once

// The one door through which a driver delivers samples, and accounts for those it refuses.

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <cstring>
#include <optional>
#include <span>
#include <stdexcept>
#include <type_traits>
#include <utility>
#include <vector>

#include "drivers/description.h"

namespace imunoise::plugin {

/// Why a sample that was received is not delivered; see driver.h.
enum class Reason : std::uint32_t {
  kOther = IMUNOISE_REFUSED_OTHER,
  kChecksum = IMUNOISE_REFUSED_CHECKSUM,
  kMalformed = IMUNOISE_REFUSED_MALFORMED,
  kStale = IMUNOISE_REFUSED_STALE,
  kOutOfRange = IMUNOISE_REFUSED_OUT_OF_RANGE,
  kFault = IMUNOISE_REFUSED_FAULT,
  kOverrun = IMUNOISE_REFUSED_OVERRUN,
  kSibling = IMUNOISE_REFUSED_SIBLING,
};

/// What is known of a sample besides its numbers; see imunoise_block.
struct Stamp {
  std::int64_t host_time_ns = 0;
  std::uint64_t counter = 0;
  std::int64_t device_time_ns = 0;
  std::uint32_t flags = 0;
};

/// Samples of one stream that wait to be delivered. Drivers reach it through Samples.
class StreamQueue {
 public:
  explicit StreamQueue(const drivers::Stream& stream)
      : stream_(stream),
        columns_(stream.channels.size()),
        faults_(stream.channels.size()),
        refused_(stream.channels.size() * IMUNOISE_REFUSED_REASONS) {}

  /// Makes room for `count` samples at the end and returns the index of the first.
  std::size_t grow(std::size_t count) {
    settle();
    const std::size_t first = stamps_.size();
    stamps_.resize(first + count);
    fit_columns();
    return first;
  }
  Stamp& stamp(std::size_t row) { return stamps_[row]; }
  void* number(std::size_t row, std::size_t channel) {
    return columns_.at(channel).data() + row * width(stream_.channels[channel].type);
  }
  const drivers::Stream& stream() const { return stream_; }

  /// Marks a channel of the last sample as refused.
  void fault(std::size_t channel, Reason reason) {
    faults_.at(channel) = reason;
    faulty_ = true;
  }
  void refuse(Reason reason, std::uint64_t count) {
    for (std::size_t c = 0; c < columns_.size(); ++c) refused(reason, c) += count;
    any_refused_ = true;
  }

  bool has_news() {
    settle();
    return begin_ < stamps_.size() || any_refused_;
  }
  /// Moves what fits into the host's block.
  void deliver(imunoise_block& block) {
    const std::size_t rows = std::min<std::size_t>(block.row_capacity, stamps_.size() - begin_);
    for (std::size_t i = 0; i < rows; ++i) {
      const Stamp& stamp = stamps_[begin_ + i];
      block.host_time_ns[i] = stamp.host_time_ns;
      block.device_time_ns[i] = stamp.device_time_ns;
      block.counter[i] = stamp.counter;
      block.flags[i] = stamp.flags;
    }
    for (std::size_t c = 0; c < columns_.size(); ++c) {
      const std::size_t bytes = width(stream_.channels[c].type);
      if (rows > 0) {
        std::memcpy(block.columns[c], columns_[c].data() + begin_ * bytes, rows * bytes);
      }
      for (std::uint32_t k = 0; k < IMUNOISE_REFUSED_REASONS; ++k) {
        // A host older than this header knows fewer reasons: the others are "other".
        const std::size_t known = k < block.reason_count ? k : 0;
        block.refused[known * block.column_capacity + c] += refused(static_cast<Reason>(k), c);
      }
    }
    block.rows = static_cast<std::uint32_t>(rows);
    begin_ += rows;
    if (begin_ == stamps_.size()) clear();
    std::fill(refused_.begin(), refused_.end(), 0);
    any_refused_ = false;
  }

 private:
  std::uint64_t& refused(Reason reason, std::size_t channel) {
    return refused_[static_cast<std::size_t>(reason) * columns_.size() + channel];
  }
  // Takes the last sample back if one of its channels was refused.
  void settle() {
    if (!faulty_) return;
    for (std::size_t c = 0; c < columns_.size(); ++c) {
      ++refused(faults_[c].value_or(Reason::kSibling), c);
      faults_[c].reset();
    }
    stamps_.pop_back();
    fit_columns();
    faulty_ = false;
    any_refused_ = true;
  }
  void clear() {
    begin_ = 0;
    stamps_.clear();
    fit_columns();
  }
  // Gives every column as many numbers as there are samples.
  void fit_columns() {
    for (std::size_t c = 0; c < columns_.size(); ++c) {
      columns_[c].resize(stamps_.size() * width(stream_.channels[c].type));
    }
  }

  const drivers::Stream& stream_;
  std::vector<Stamp> stamps_;
  std::vector<std::vector<std::byte>> columns_;
  std::size_t begin_ = 0;  // samples before it are delivered
  std::vector<std::optional<Reason>> faults_;
  bool faulty_ = false;
  std::vector<std::uint64_t> refused_;  // [reason][channel]
  bool any_refused_ = false;
};

/// The sample that was added last, to be filled. Good until the next is added.
class Row {
 public:
  Row(StreamQueue& queue, std::size_t row) : queue_(queue), row_(row) {}

  /// Stores a number as the channel's type. One that is not finite or does not fit refuses the
  /// sample (Reason::kOutOfRange). A fraction for a channel of integers is a programming error
  /// (std::logic_error).
  template <class Number>
  Row& set(std::size_t channel, Number number) {
    static_assert(std::is_arithmetic_v<Number>);
    drivers::with_number_type(queue_.stream().channels.at(channel).type, [&](auto stored) {
      if (!convert(number, stored)) return refuse(channel, Reason::kOutOfRange);
      std::memcpy(queue_.number(row_, channel), &stored, sizeof stored);
    });
    return *this;
  }
  /// This channel's number is bad: the whole sample is refused, other channels as kSibling.
  void refuse(std::size_t channel, Reason reason) { queue_.fault(channel, reason); }

 private:
  template <class Number, class Stored>
  static bool convert(Number number, Stored& stored) {
    if constexpr (std::is_floating_point_v<Stored>) {
      stored = static_cast<Stored>(number);
      return std::isfinite(stored);
    } else if constexpr (std::is_integral_v<Number>) {
      stored = static_cast<Stored>(number);
      return std::in_range<Stored>(number);
    } else {
      throw std::logic_error("a fraction was set in a channel of integers");
    }
  }

  StreamQueue& queue_;
  std::size_t row_;
};

/// Many samples added at once, to be filled by whole columns. Good until the next are added.
class Rows {
 public:
  Rows(StreamQueue& queue, std::size_t first, std::size_t count)
      : queue_(queue), first_(first), count_(count) {}

  std::span<Stamp> stamps() { return {&queue_.stamp(first_), count_}; }
  /// Numbers of a channel of exactly this type (else std::logic_error). They must be finite.
  template <class Number>
  std::span<Number> column(std::size_t channel) {
    if (queue_.stream().channels.at(channel).type != drivers::number_type<Number>()) {
      throw std::logic_error("a channel was filled as another type");
    }
    return {static_cast<Number*>(queue_.number(first_, channel)), count_};
  }

 private:
  StreamQueue& queue_;
  std::size_t first_;
  std::size_t count_;
};

/// What a driver has to deliver, of all its streams; they are numbered as in DeviceInfo.
class Samples {
 public:
  /// Borrows the streams.
  explicit Samples(const std::vector<drivers::Stream>& streams) {
    queues_.reserve(streams.size());
    for (const drivers::Stream& stream : streams) queues_.emplace_back(stream);
  }

  /// Adds a sample; its numbers are 0 until set.
  Row add(std::size_t stream, const Stamp& stamp) {
    StreamQueue& queue = queues_.at(stream);
    const std::size_t row = queue.grow(1);
    queue.stamp(row) = stamp;
    return {queue, row};
  }
  /// Adds `count` samples (at least 1), all of them 0 until filled.
  Rows add_many(std::size_t stream, std::size_t count) {
    StreamQueue& queue = queues_.at(stream);
    return {queue, queue.grow(count), count};
  }
  /// Counts samples that were received but cannot be delivered, in all channels of the stream.
  void refuse(std::size_t stream, Reason reason, std::uint64_t count = 1) {
    queues_.at(stream).refuse(reason, count);
  }
  /// Says that nothing will ever come again.
  void end() { ended_ = true; }

  bool ended() const { return ended_; }
  /// Delivers news of one stream, each in its turn. False where there is none.
  bool deliver(imunoise_block& block) {
    for (std::size_t k = 0; k < queues_.size(); ++k) {
      const std::size_t stream = (next_ + k) % queues_.size();
      if (!queues_[stream].has_news()) continue;
      block.stream = static_cast<std::uint32_t>(stream);
      queues_[stream].deliver(block);
      next_ = stream + 1;
      return true;
    }
    return false;
  }

 private:
  std::vector<StreamQueue> queues_;
  std::size_t next_ = 0;
  bool ended_ = false;
};

}  // namespace imunoise::plugin
