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
// A bridge that polls, and had fewer bursts before it than this when more were sent, may have run
// dry meanwhile.
constexpr std::size_t kSafelyAhead = 32;
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
      // Polled bursts follow each other at once, whatever the rate.
      ahead_(poll ? kMostAhead
                  : std::clamp(static_cast<std::size_t>(kAheadTime * rate(settings)), kGroup,
                               kMostAhead)),
      rows_(poll),
      last_sample_(bus.now()),
      next_diagnosis_(bus.now()) {}

// What came while nobody looked tells whether the queue ran dry.
void BurstReader::read(plugin::Samples& samples, usb::Duration timeout) {
  const bool came = take_answers(samples, 0ns);
  top_up();
  if (!came) take_answers(samples, timeout);
}

bool BurstReader::take_answers(plugin::Samples& samples, usb::Duration timeout) {
  std::vector<SpiAnswer> answers = bus_.receive(timeout);
  correct_times(answers);
  for (const SpiAnswer& answer : answers) take(answer, samples);
  return !answers.empty();
}

// Answers that were held up on their way came, for all we can see, at once. But each data-ready is
// a period after the one before.
// Where they came in several portions, none is stamped before one that was delivered.
void BurstReader::correct_times(std::vector<SpiAnswer>& answers) {
  std::int64_t latest = INT64_MAX;
  for (std::size_t i = answers.size(); i-- > 0;) {
    latest = std::min(latest, answers[i].host_time_ns);
    answers[i].host_time_ns = latest;
    if (is_burst(questions_[i])) latest -= least_period_ns_;
  }
  for (SpiAnswer& answer : answers) {
    answer.host_time_ns = std::max(answer.host_time_ns, last_time_ns_ + 1);
    last_time_ns_ = answer.host_time_ns;
  }
}

SpiFrame BurstReader::burst_frame() const {
  return {{kBurstRequest.begin(), kBurstRequest.end()}, !poll_, poll_ ? kPause : 0us};
}

void BurstReader::top_up() {
  if (questions_.size() < (poll_ ? kSafelyAhead : 1)) resumes_ = true;
  if (std::exchange(wants_diagnosis_, false)) send_diagnosis();
  for (; bursts_ + kGroup <= ahead_; bursts_ += kGroup) {
    bus_.send(std::vector<SpiFrame>(kGroup, burst_frame()));
    for (std::size_t i = 0; i < kGroup; ++i) questions_.push_back(next_burst());
  }
}

// At the beginning, and where the queue ran dry: the sensor may have gone on without us.
BurstReader::Question BurstReader::next_burst() {
  return std::exchange(resumes_, false) ? Question::kFirstBurst : Question::kBurst;
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
                    {next_burst(), Question::kDiagnosisCommand, Question::kDiagnosis});
}

void BurstReader::take(const SpiAnswer& answer, plugin::Samples& samples) {
  const Question question = questions_.front();
  questions_.pop_front();
  if (is_burst(question)) {
    --bursts_;
    take_burst(question, answer, samples);
  } else if (question == Question::kDiagnosis) {
    take_diagnosis(answer);
  }
}

void BurstReader::take_burst(Question question, const SpiAnswer& answer, plugin::Samples& samples) {
  if (question == Question::kFirstBurst) {
    if (std::exchange(started_, true)) rows_.mark_gap();
    // Outputs that have waited for a reader may be renewed while they are read, and still all be
    // new.
    if (poll_) return rows_.refuse(plugin::Reason::kStale, samples);
  }
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
