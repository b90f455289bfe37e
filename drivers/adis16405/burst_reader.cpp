#include "drivers/adis16405/burst_reader.h"

#include <algorithm>
#include <cassert>
#include <cmath>
#include <utility>

namespace imunoise::drivers::adis16405 {
namespace {

using namespace std::chrono_literals;
using plugin::Reason;

constexpr std::size_t kGroup = 8;  // bursts that travel to the bridge in one transfer
constexpr std::size_t kMostAhead = 128;
constexpr double kAheadTime = 0.15;  // s
// Time for the sensor between a burst and what follows it at once (datasheet: 75 µs at most).
constexpr std::chrono::microseconds kPause = 150us;
constexpr usb::Duration kDiagnosisPeriod = 1s;

struct StreamOfBurst {
  const char* name;
  std::uint16_t channels;
};
constexpr std::array kStreams = {StreamOfBurst{"imu", kInertialChannels},
                                 StreamOfBurst{"magnetometer", kMagneticChannels},
                                 StreamOfBurst{"housekeeping", kSlowChannels}};
constexpr std::size_t kImu = 0;

double rate(const Settings& settings) { return sample_rate(settings.sample_period).value; }

// The sensor's clock may be fast by 3 %.
std::int64_t least_period_ns(const Settings& settings) {
  return std::llround(0.97e9 / rate(settings));
}

template <class Visitor>
void for_each_channel(unsigned channels, Visitor&& visitor) {
  for (std::size_t i = 0; i < kBurstChannels; ++i) {
    if ((channels >> i & 1U) != 0) visitor(i);
  }
}

// The outputs of 14 bits with a sign end there; the others cannot reach their ends.
bool saturated(std::int16_t counts) { return counts == -8192 || counts == 8191; }

}  // namespace

std::vector<Stream> describe_streams(const Settings& settings) {
  const auto scales = count_scales(settings.sensitivity_averaging);
  assert(scales);
  std::vector<Stream> out;
  for (const StreamOfBurst& from : kStreams) {
    Stream stream{from.name, {}, rate(settings)};
    for_each_channel(from.channels, [&](std::size_t i) {
      const CountScale& scale = (*scales)[i];
      stream.channels.push_back({std::string(kChannelNames[i]), std::string(scale.unit),
                                 NumberType::kInt16, scale.scale, scale.offset});
    });
    out.push_back(std::move(stream));
  }
  return out;
}

BurstReader::BurstReader(SpiBus& bus, const Settings& settings, bool poll, Note note)
    : bus_(bus),
      poll_(poll),
      note_(std::move(note)),
      least_period_ns_(poll ? 0 : least_period_ns(settings)),
      ahead_(std::clamp(static_cast<std::size_t>(kAheadTime * rate(settings)), kGroup, kMostAhead)),
      last_sample_(bus.now()),
      next_diagnosis_(bus.now()) {
  for (const StreamOfBurst& stream : kStreams) {
    streams_.push_back({Gatherer(stream.channels), IMUNOISE_SAMPLE_AFTER_RESTART});
  }
}

void BurstReader::read(plugin::Samples& samples, usb::Duration timeout) {
  top_up();
  std::vector<SpiAnswer> answers = bus_.receive(timeout);
  correct_times(answers);
  for (const SpiAnswer& answer : answers) take(answer, samples);
}

// Answers that were held up on their way came, for all we can see, at once. But each data-ready is
// a period after the one before.
void BurstReader::correct_times(std::vector<SpiAnswer>& answers) const {
  std::int64_t latest = INT64_MAX;
  for (std::size_t i = answers.size(); i-- > 0;) {
    latest = std::min(latest, answers[i].host_time_ns);
    answers[i].host_time_ns = latest;
    if (questions_[i] == Question::kBurst) latest -= least_period_ns_;
  }
}

SpiFrame BurstReader::burst_frame() const {
  return {{kBurstRequest.begin(), kBurstRequest.end()}, !poll_, poll_ ? kPause : 0us};
}

void BurstReader::top_up() {
  if (questions_.empty()) start_anew();
  if (std::exchange(wants_diagnosis_, false)) send_diagnosis();
  for (; bursts_ + kGroup <= ahead_; bursts_ += kGroup) {
    bus_.send(std::vector<SpiFrame>(kGroup, burst_frame()));
    questions_.insert(questions_.end(), kGroup, Question::kBurst);
  }
}

// At the beginning, and where the queue ran dry: the sensor may have gone on without us. Outputs
// that have waited for a reader may be renewed while they are read, and still all be new.
void BurstReader::start_anew() {
  if (std::exchange(started_, true)) {
    for (State& stream : streams_) stream.next_flags |= IMUNOISE_SAMPLE_AFTER_GAP;
  }
  skips_burst_ = poll_;
}

// Right behind a burst, when the sensor has the longest time until the next.
void BurstReader::send_diagnosis() {
  std::vector<SpiFrame> frames = {burst_frame()};
  frames.front().pause = kPause;
  for (SpiFrame& frame : register_read_frames(Register::kDiagnosticStatus)) {
    frames.push_back(std::move(frame));
  }
  bus_.send(frames);
  ++bursts_;
  questions_.insert(questions_.end(),
                    {Question::kBurst, Question::kDiagnosisCommand, Question::kDiagnosis});
}

void BurstReader::take(const SpiAnswer& answer, plugin::Samples& samples) {
  const Question question = questions_.front();
  questions_.pop_front();
  if (question == Question::kBurst) {
    --bursts_;
    take_burst(answer, samples);
  } else if (question == Question::kDiagnosis) {
    take_diagnosis(answer);
  }
}

void BurstReader::take_burst(const SpiAnswer& answer, plugin::Samples& samples) {
  if (std::exchange(skips_burst_, false)) {
    for (std::size_t s = 0; s < streams_.size(); ++s) refuse(s, Reason::kStale, 1, samples);
    return;
  }
  const auto burst = parse_burst(answer.bytes);
  for (std::size_t s = 0; s < streams_.size(); ++s) {
    if (!burst) {
      refuse(s, Reason::kMalformed, 1, samples);
      continue;
    }
    Gatherer& gatherer = streams_[s].gatherer;
    const Gathered gathered = gatherer.take(*burst);
    refuse(s, Reason::kMalformed, gatherer.take_lost(), samples);
    if (gathered == Gathered::kSample) add(s, answer, samples);
    if (gathered == Gathered::kNothingNew) refuse(s, Reason::kStale, 1, samples);
  }
  if (burst && burst->alarm != 0 && bus_.now() >= next_diagnosis_) {
    wants_diagnosis_ = true;
    next_diagnosis_ = bus_.now() + kDiagnosisPeriod;
  }
}

void BurstReader::add(std::size_t stream, const SpiAnswer& answer, plugin::Samples& samples) {
  const Burst& burst = streams_[stream].gatherer.sample();
  std::uint32_t flags = std::exchange(streams_[stream].next_flags, 0);
  if (burst.alarm != 0) flags |= IMUNOISE_SAMPLE_SUSPECT;
  for_each_channel(kStreams[stream].channels, [&](std::size_t i) {
    if (saturated(burst.counts[i])) flags |= IMUNOISE_SAMPLE_SATURATED;
  });
  plugin::Row row = samples.add(stream, {answer.host_time_ns, 0, 0, flags});
  std::size_t column = 0;
  for_each_channel(kStreams[stream].channels,
                   [&](std::size_t i) { row.set(column++, burst.counts[i]); });
  if (stream == kImu) last_sample_ = bus_.now();
}

// Polling reads the same sample many times, so there a stale burst is no hole in the series.
void BurstReader::refuse(std::size_t stream, Reason reason, std::size_t count,
                         plugin::Samples& samples) {
  if (count == 0) return;
  samples.refuse(stream, reason, count);
  if (!poll_ || reason != Reason::kStale) {
    streams_[stream].next_flags |= IMUNOISE_SAMPLE_AFTER_GAP;
  }
}

void BurstReader::take_diagnosis(const SpiAnswer& answer) {
  const auto status = BigEndianReader(answer.bytes).take<std::uint16_t>();
  if (status != diagnosis_ && status != 0) note_("DIAG_STAT " + describe_diagnosis(status));
  diagnosis_ = status;
}

}  // namespace imunoise::drivers::adis16405
