#pragma once

// A device behind its plugin, read like the recorder does, with everything kept.

#include <chrono>
#include <cstdint>
#include <memory>
#include <mutex>
#include <numeric>
#include <span>
#include <string>
#include <vector>

#include "drivers/host/device.h"
#include "drivers/host/load.h"

namespace imunoise::testing {

/// One sample as it was delivered.
struct ReadRow {
  std::int64_t host_time_ns = 0;
  std::int64_t device_time_ns = 0;
  std::uint64_t counter = 0;
  std::uint32_t flags = 0;
  std::vector<double> numbers;  ///< The device's own; whole numbers are exact up to 2^53.
};

class RecordingSession {
 public:
  using Clock = std::chrono::steady_clock;

  /// Opens a device of a driver in `folder`; with what comes over its wire where that is wanted.
  static Result<std::unique_ptr<RecordingSession>> open(
      const std::string& folder, const std::string& driver,
      const std::vector<drivers::OptionText>& options, bool with_wire = false,
      std::stop_token stop = {}) {
    static const drivers::Drivers kDrivers = drivers::load_drivers({folder});
    const auto found = kDrivers.find(driver);
    if (!found) return tl::make_unexpected(found.error());
    auto out = std::make_unique<RecordingSession>();
    drivers::WireHandler wire;
    if (with_wire) {
      wire = [to = out.get()](auto bytes) { to->wire_.append(bytes.begin(), bytes.end()); };
    }
    auto device = drivers::Device::open(
        **found, options,
        [to = out.get()](std::string_view text) {
          const std::lock_guard lock(to->mutex_);
          to->notes_.emplace_back(text);
        },
        std::move(wire), std::move(stop));
    if (!device) return tl::make_unexpected(device.error());
    out->device_ = std::move(*device);
    out->rows_.resize(out->device_->info().streams.size());
    out->refused_.resize(out->rows_.size(), std::vector<std::uint64_t>(IMUNOISE_REFUSED_REASONS));
    return out;
  }

  /// Reads until `done()` or until `patience` is over (false), or the device fails (false).
  template <class Done>
  bool read_until(Done&& done, std::chrono::milliseconds patience = std::chrono::seconds(20)) {
    const auto deadline = Clock::now() + patience;
    drivers::SampleBlock block = device_->make_block(100);
    while (!done()) {
      if (Clock::now() > deadline) return false;
      const auto outcome = device_->read(std::chrono::milliseconds(20), block);
      if (!outcome) {
        failure_ = outcome.error().message;
        return false;
      }
      if (*outcome == drivers::ReadOutcome::kDisconnected) {
        disconnections_.push_back(device_->disconnection());
      }
      if (*outcome == drivers::ReadOutcome::kSamples) take(block);
    }
    return true;
  }
  /// Reads until there are so many rows of a stream.
  bool read_rows(std::size_t count, std::size_t stream = 0) {
    return read_until([&] { return rows_[stream].size() >= count; });
  }

  const std::vector<ReadRow>& rows(std::size_t stream = 0) const { return rows_[stream]; }
  std::uint64_t refused(int reason, std::size_t stream = 0) const {
    return refused_[stream][static_cast<std::size_t>(reason)];
  }
  std::uint64_t all_refused(std::size_t stream = 0) const {
    return std::accumulate(refused_[stream].begin(), refused_[stream].end(), std::uint64_t{0});
  }
  /// Bytes that came over the wire since it was opened. While nothing is being read.
  const std::string& wire() const { return wire_; }
  const std::vector<std::string>& disconnections() const { return disconnections_; }
  const std::string& failure() const { return failure_; }
  drivers::Device& device() { return *device_; }
  const drivers::DeviceInfo& info() const { return device_->info(); }
  /// Everything that the driver noted, a line each.
  std::string notes() const {
    const std::lock_guard lock(mutex_);
    std::string out;
    for (const std::string& note : notes_) out += note + "\n";
    return out;
  }

 private:
  void take(const drivers::SampleBlock& block) {
    const std::size_t s = block.stream_index();
    for (std::size_t k = 0; k < IMUNOISE_REFUSED_REASONS; ++k) {
      refused_[s][k] += block.refused(k, 0);
    }
    for (std::size_t i = 0; i < block.rows(); ++i) {
      ReadRow row{block.host_time_ns()[i],
                  block.device_time_ns()[i],
                  block.counter()[i],
                  block.flags()[i],
                  {}};
      for (std::size_t c = 0; c < block.stream().channels.size(); ++c) {
        drivers::with_number_type(block.stream().channels[c].type, [&]<class Number>(Number) {
          row.numbers.push_back(static_cast<double>(block.column<Number>(c)[i]));
        });
      }
      rows_[s].push_back(std::move(row));
    }
  }

  mutable std::mutex mutex_;  // of the notes
  std::vector<std::string> notes_;
  std::string wire_;
  std::unique_ptr<drivers::Device> device_;
  std::vector<std::vector<ReadRow>> rows_;           // by stream
  std::vector<std::vector<std::uint64_t>> refused_;  // by stream and reason, first channel
  std::vector<std::string> disconnections_;
  std::string failure_;
};

}  // namespace imunoise::testing
