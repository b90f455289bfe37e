#include "daemon/acquire/stillness.h"

#include <algorithm>
#include <cmath>

#include "core/support/units.h"

namespace imunoise::acquire {
namespace {

constexpr std::size_t kWindow = 120;       // blocks that a block is compared with
constexpr std::size_t kFewest = 30;        // before the watch begins
constexpr std::size_t kFewestSamples = 8;  // of a block
constexpr double kBlockTime = 1.0;         // s
constexpr double kThreshold = 10.0;        // robust standard deviations
constexpr std::size_t kTogether = 3;       // an event goes on after fewer still blocks than this
constexpr std::size_t kMostEvents = 1000;
constexpr double kNormal =
    1.4826;  // standard deviation of a normal number over its median deviation

double median(std::vector<double> values) {
  const auto middle = values.begin() + static_cast<std::ptrdiff_t>(values.size() / 2);
  std::nth_element(values.begin(), middle, values.end());
  return *middle;
}

double median_of(const std::deque<double>& values) {
  return median({values.begin(), values.end()});
}

double median_deviation(const std::deque<double>& values, double center) {
  std::vector<double> deviations;
  for (const double value : values) deviations.push_back(std::abs(value - center));
  return median(std::move(deviations));
}

void push(std::deque<double>& window, double value) {
  window.push_back(value);
  if (window.size() > kWindow) window.pop_front();
}

bool watched(const v1::RecordedChannel& channel) {
  const auto unit = parse_unit(channel.units());
  return unit &&
         (unit->quantity == Quantity::kAngularRate || unit->quantity == Quantity::kAcceleration);
}

double quantum_of(const v1::RecordedChannel& channel) {
  return channel.dtype().find('i') != std::string::npos ? 1.0 : 0.0;
}

}  // namespace

ChannelWatch::ChannelWatch(std::size_t block_samples, double quantum)
    : block_(static_cast<double>(block_samples)), quantum_(quantum) {}

void ChannelWatch::take(double number) {
  if (count_ == 0) origin_ = before_ ? *before_ : number;
  ++count_;
  sum_ += number - origin_;
  squares_ += (number - origin_) * (number - origin_);
}

double ChannelWatch::mean() const { return origin_ + sum_ / block_; }

double ChannelWatch::log_variance() const {
  const double about = sum_ / block_;
  const double variance = std::max(0.0, squares_ / block_ - about * about);
  // Rounding to a number of the device, or of the machine, is always there.
  const double rounding = quantum_ * quantum_ / 12.0 + 1e-24 * origin_ * origin_ + 1e-300;
  return std::log(variance + rounding);
}

double ChannelWatch::size() const {
  if (log_variances_.size() < kFewest || steps_.size() < kFewest) return 0.0;
  const double usual = median_of(log_variances_);
  const double spread =
      std::max(kNormal * median_deviation(log_variances_, usual), std::sqrt(2.0 / block_));
  const double growth = (log_variance() - usual) / spread;
  if (!before_) return std::max(growth, 0.0);
  const double finest = std::max(quantum_, std::sqrt(std::exp(usual))) / std::sqrt(12.0 * block_);
  const double step = std::max(kNormal * median_of(steps_), finest);
  return std::max(growth, std::abs(mean() - *before_) / step);
}

void ChannelWatch::end_block(bool still) {
  if (still) {
    push(log_variances_, log_variance());
    if (before_) push(steps_, std::abs(mean() - *before_));
  }
  before_ = mean();
  count_ = 0;
  sum_ = squares_ = 0.0;
}

void ChannelWatch::restart() {
  before_.reset();
  count_ = 0;
  sum_ = squares_ = 0.0;
}

void ChannelWatch::forget() {
  steps_.clear();
  log_variances_.clear();
}

StillnessWatch::StillnessWatch(const v1::RecordedDevice& device) : device_(device) {
  for (const v1::RecordedStream& stream : device.streams()) {
    Stream& to = streams_.emplace_back();
    to.block_samples = std::max(
        kFewestSamples, static_cast<std::size_t>(std::lround(stream.rate_hz() * kBlockTime)));
    if (stream.rate_hz() <= 0.0) continue;
    for (int c = 0; c < stream.channels_size(); ++c) {
      if (!watched(stream.channels(c))) continue;
      to.channels.push_back({static_cast<std::size_t>(c),
                             ChannelWatch(to.block_samples, quantum_of(stream.channels(c)))});
    }
  }
}

void StillnessWatch::take(const recording::Block& block) {
  Stream& stream = streams_[block.stream];
  if (stream.channels.empty()) return;
  const recording::Rows& rows = block.rows;
  for (std::size_t i = 0; i < rows.size(); ++i) {
    if ((rows.flags[i] & recording::kLostBefore) != 0) {
      for (Watched& one : stream.channels) one.watch.restart();
      stream.filled = 0;
    }
    if (stream.filled == 0) stream.begin_ns = rows.host_time[i];
    for (Watched& one : stream.channels) {
      std::visit([&](const auto& numbers) { one.watch.take(static_cast<double>(numbers[i])); },
                 rows.channels[one.channel]);
    }
    if (++stream.filled == stream.block_samples) end_block(block.stream, rows.host_time[i]);
  }
}

void StillnessWatch::end_block(std::size_t index, std::int64_t end_ns) {
  Stream& stream = streams_[index];
  double largest = 0.0;
  std::size_t where = 0;
  for (const Watched& one : stream.channels) {
    const double size = one.watch.size();
    if (size > largest) where = one.channel;
    largest = std::max(largest, size);
  }
  const bool still = largest < kThreshold;
  for (Watched& one : stream.channels) one.watch.end_block(still);
  stream.filled = 0;
  if (still) {
    stream.disturbed = 0;
    if (++stream.still >= kTogether) stream.event.reset();
    return;
  }
  if (++stream.disturbed >= kWindow) {
    for (Watched& one : stream.channels) one.watch.forget();
  }
  stream.still = 0;
  if (!stream.event) {
    if (found_.size() >= kMostEvents) return;
    stream.event = found_.size();
    v1::Disturbance& made = found_.emplace_back();
    made.set_device(device_.name());
    made.set_begin_ns(stream.begin_ns);
  }
  v1::Disturbance& event = found_[*stream.event];
  event.set_end_ns(end_ns);
  if (largest <= event.size()) return;
  event.set_size(largest);
  event.set_channel(
      device_.streams(static_cast<int>(index)).channels(static_cast<int>(where)).name());
}

std::vector<v1::Disturbance> merge_disturbances(std::vector<v1::Disturbance> all) {
  std::stable_sort(all.begin(), all.end(),
                   [](const auto& a, const auto& b) { return a.begin_ns() < b.begin_ns(); });
  std::vector<v1::Disturbance> out;
  for (const v1::Disturbance& one : all) {
    if (out.empty() || one.begin_ns() > out.back().end_ns()) {
      out.push_back(one);
      continue;
    }
    v1::Disturbance& last = out.back();
    last.set_end_ns(std::max(last.end_ns(), one.end_ns()));
    if (one.size() > last.size()) {
      last.set_size(one.size());
      last.set_channel(one.channel());
    }
  }
  if (out.size() > kMostEvents) out.resize(kMostEvents);
  return out;
}

}  // namespace imunoise::acquire
