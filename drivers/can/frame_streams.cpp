#include "drivers/can/frame_streams.h"

#include <algorithm>
#include <cmath>
#include <utility>

namespace imunoise::can {
namespace {

// To three digits: what a person would have configured.
double round_rate(double rate) {
  const double unit = std::pow(10.0, std::floor(std::log10(rate)) - 2.0);
  return std::round(rate / unit) * unit;
}

}  // namespace

// Frames a second; 0: not known. By the median time that half of the frames take: those that waited
// in a queue came late.
double FrameStreams::Arrivals::rate() const {
  if (times.size() < 2) return 0.0;
  const std::size_t half = times.size() / 2;
  std::vector<std::int64_t> taken;
  for (std::size_t i = half; i < times.size(); ++i) taken.push_back(times[i] - times[i - half]);
  const auto middle = taken.begin() + static_cast<std::ptrdiff_t>(taken.size() / 2);
  std::nth_element(taken.begin(), middle, taken.end());
  return *middle > 0 ? static_cast<double>(half) * 1e9 / static_cast<double>(*middle) : 0.0;
}

Result<FrameStreams> FrameStreams::make(const drivers::CanChannels& channels) {
  auto streams = CanStream::all_of(channels);
  if (!streams) return tl::make_unexpected(streams.error());
  FrameStreams out(channels);
  out.streams_ = std::move(*streams);
  out.arrivals_.resize(out.streams_.size());
  out.restart();
  return out;
}

std::vector<drivers::Stream> FrameStreams::descriptions() const {
  std::vector<drivers::Stream> out;
  for (const CanStream& stream : streams_) out.push_back(stream.description());
  return out;
}

template <class Visit>
void FrameStreams::for_streams_of(const drivers::CanFrame& frame, Visit visit) {
  const drivers::CanMessage* const message = channels_->database().find(frame.id, frame.extended);
  if (message == nullptr) return;
  drivers::Refusals ignored;  // signals that are missing are counted by their streams
  drivers::decode_signals(*message, frame.data(), present_, ignored);
  for (std::size_t s = 0; s < streams_.size(); ++s) {
    if (&streams_[s].message() == message && streams_[s].is_in(present_)) visit(s);
  }
}

void FrameStreams::hear(const drivers::CanFrame& frame, std::int64_t time_ns) {
  for_streams_of(frame, [&](std::size_t s) { arrivals_[s].times.push_back(time_ns); });
}

const CanStream* FrameStreams::missing() const {
  for (std::size_t s = 0; s < streams_.size(); ++s) {
    if (arrivals_[s].times.empty()) return &streams_[s];
  }
  return nullptr;
}

const CanStream* FrameStreams::without_rate() const {
  for (std::size_t s = 0; s < streams_.size(); ++s) {
    if (!arrivals_[s].times.empty() && arrivals_[s].rate() == 0.0) return &streams_[s];
  }
  return nullptr;
}

std::vector<CanStream> FrameStreams::settle(std::optional<double> rate_hz, double listened_s) {
  const bool some_known = std::any_of(arrivals_.begin(), arrivals_.end(),
                                      [](const Arrivals& one) { return one.rate() > 0.0; });
  std::vector<CanStream> came;
  std::vector<CanStream> left_out;
  for (std::size_t s = 0; s < streams_.size(); ++s) {
    if (arrivals_[s].times.empty()) continue;
    double heard = arrivals_[s].rate();
    // It came once: about so often, where others are faster; else it is the fastest itself.
    if (heard == 0.0 && rate_hz) heard = some_known ? 1.0 / listened_s : *rate_hz;
    CanStream& stream = (heard > 0.0 ? came : left_out).emplace_back(std::move(streams_[s]));
    if (heard == 0.0) continue;
    stream.set_rate(rate_hz ? *rate_hz / std::max(1.0, std::round(*rate_hz / heard))
                            : round_rate(heard));
  }
  streams_ = std::move(came);
  restart();
  return left_out;
}

void FrameStreams::take(const drivers::CanFrame& frame, std::int64_t time_ns,
                        plugin::Samples& samples) {
  for_streams_of(frame, [&](std::size_t s) {
    streams_[s].add(present_, s, time_ns, std::exchange(flags_[s], 0U), samples);
  });
}

void FrameStreams::mark(std::uint32_t flags) {
  for (std::uint32_t& next : flags_) next |= flags;
}

void FrameStreams::restart() {
  flags_.assign(streams_.size(), IMUNOISE_SAMPLE_AFTER_RESTART);
  for (CanStream& stream : streams_) stream.forget_counter();
}

}  // namespace imunoise::can
