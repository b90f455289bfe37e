#include "drivers/adis16405/burst_reader.h"

#include <algorithm>
#include <cmath>
#include <utility>

namespace imunoise::drivers::adis16405 {
namespace {

using namespace std::chrono_literals;

constexpr std::size_t kGroup = 8;  // bursts that travel to the bridge in one transfer
constexpr std::size_t kMostAhead = 128;
constexpr double kAheadTime = 0.15;  // s
// Time for the sensor between a burst and what follows it at once (datasheet: 75 µs at most).
constexpr std::chrono::microseconds kPause = 150us;
constexpr usb::Duration kDiagnosisPeriod = 1s;

double rate(const Settings& settings) { return sample_rate(settings.sample_period).value; }

// The sensor's clock may be fast by 3 %.
std::int64_t least_period_ns(const Settings& settings) {
  return std::llround(0.97e9 / rate(settings));
}

}  // namespace

BurstReader::BurstReader(SpiBus& bus, const Settings& settings, bool poll, Note note,
                         plugin::WireTap wire)
    : bus_(bus),
      poll_(poll),
      note_(std::move(note)),
      wire_(std::move(wire)),
      least_period_ns_(poll ? 0 : least_period_ns(settings)),
      ahead_(std::clamp(static_cast<std::size_t>(kAheadTime * rate(settings)), kGroup, kMostAhead)),
      rows_(poll),
      last_sample_(bus.now()),
      next_diagnosis_(bus.now()) {}

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
  if (std::exchange(started_, true)) rows_.mark_gap();
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
  if (std::exchange(skips_burst_, false)) return rows_.refuse(plugin::Reason::kStale, samples);
  if (wire_) wire_(answer.bytes);
  const BurstRows::Taken taken = rows_.take(answer.bytes, answer.host_time_ns, samples);
  if (taken.inertial) last_sample_ = bus_.now();
  if (taken.alarm && bus_.now() >= next_diagnosis_) {
    wants_diagnosis_ = true;
    next_diagnosis_ = bus_.now() + kDiagnosisPeriod;
  }
}

void BurstReader::take_diagnosis(const SpiAnswer& answer) {
  const auto status = BigEndianReader(answer.bytes).take<std::uint16_t>();
  if (status != diagnosis_ && status != 0) note_("DIAG_STAT " + describe_diagnosis(status));
  diagnosis_ = status;
}

}  // namespace imunoise::drivers::adis16405
