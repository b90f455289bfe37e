#include "core/stillness/stillness.h"

#include <algorithm>
#include <cmath>

namespace imunoise {
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

std::size_t samples_of_block(Hertz rate) {
  return std::max(kFewestSamples, static_cast<std::size_t>(std::lround(rate.value * kBlockTime)));
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

Stillness::Stillness(Hertz rate, const std::vector<double>& quanta)
    : block_samples_(samples_of_block(rate)) {
  for (const double quantum : quanta) channels_.emplace_back(block_samples_, quantum);
}

void Stillness::lost() {
  for (ChannelWatch& one : channels_) one.restart();
  filled_ = 0;
}

void Stillness::end_row(std::int64_t time) {
  if (filled_ == 0) begin_ = time;
  if (++filled_ == block_samples_) end_block(time);
}

void Stillness::end_block(std::int64_t time) {
  double largest = 0.0;
  std::size_t where = 0;
  std::size_t together = 0;
  for (std::size_t c = 0; c < channels_.size(); ++c) {
    const double size = channels_[c].size();
    if (size >= kThreshold) ++together;
    if (size > largest) where = c;
    largest = std::max(largest, size);
  }
  const bool still = largest < kThreshold;
  for (ChannelWatch& one : channels_) one.end_block(still);
  filled_ = 0;
  if (still) {
    disturbed_ = 0;
    if (++still_ >= kTogether) open_ = false;
    return;
  }
  if (++disturbed_ >= kWindow) {
    for (ChannelWatch& one : channels_) one.forget();
  }
  still_ = 0;
  if (!open_) {
    if (found_.size() >= kMostEvents) return;
    open_ = true;
    found_.push_back({begin_, time});
  }
  Disturbance& event = found_.back();
  event.end = time;
  event.channels = std::max(event.channels, together);
  if (largest <= event.size) return;
  event.size = largest;
  event.channel = where;
}

}  // namespace imunoise
