#include "core/faults/suspicion.h"

#include <algorithm>
#include <cmath>
#include <utility>

namespace imunoise {
namespace {

constexpr double kToTellApart = 3.0;  // nats

void keep_stronger(Evidence& best, const Evidence& other) {
  if (other.gain > best.gain) best = other;
}

}  // namespace

Suspicion::Suspicion(std::vector<Eigen::Index> sensors, std::size_t detected, std::size_t decide)
    : sensors_(std::move(sensors)),
      detected_(detected),
      decide_(decide),
      own_noise_(sensors_.size(), 0.0) {
  strongest_.fill(std::vector<Evidence>(sensors_.size()));
  begun_.fill(std::vector<Evidence>(sensors_.size(), Evidence{.onset = detected_}));
  later_.fill(std::vector<Evidence>(sensors_.size()));
}

void Suspicion::offer(FaultKind kind, std::size_t index, const Evidence& evidence) {
  const auto row = static_cast<std::size_t>(kind);
  now_ = std::max(now_, evidence.end);
  follow(kind, index, evidence);
  keep_stronger(strongest_[row][index], evidence);
  if (evidence.onset <= detected_) keep_stronger(begun_[row][index], evidence);
}

void Suspicion::follow(FaultKind kind, std::size_t index, const Evidence& evidence) {
  const auto row = static_cast<std::size_t>(kind);
  const Evidence& best = strongest_[row][index];
  Evidence& later = later_[row][index];
  if (evidence.gain > best.gain) {
    later = {};
  } else if (kind == FaultKind::kNoisy) {
    if (evidence.onset >= best.end) keep_stronger(later, evidence);
  } else if (kind == FaultKind::kStep && evidence.length() >= 2 * best.length()) {
    const auto [first, last] = std::minmax(evidence.onset, best.onset);
    if (4 * (last - first) <= evidence.length()) later = evidence;
  }
}

// A longer look at a real step finds the same height.
bool Suspicion::came_back(std::size_t index) const {
  constexpr double kLess = 0.7;
  constexpr double kSurely = 3.0;  // standard errors
  const auto row = static_cast<std::size_t>(FaultKind::kStep);
  const Evidence& best = strongest_[row][index];
  const Evidence& later = later_[row][index];
  const double along = best.size < 0.0 ? -later.size : later.size;
  return later.end > 0 && along + kSurely * later.size_error < kLess * std::abs(best.size);
}

// Quiet for as long again, and for some readings at least. What predictions keep of it for a while
// is no noise.
bool Suspicion::is_over(std::size_t index) const {
  constexpr std::size_t kFewest = 16;
  constexpr double kKept = 0.1;  // of its gain
  const auto row = static_cast<std::size_t>(FaultKind::kNoisy);
  const Evidence& best = strongest_[row][index];
  return now_ >= best.end + std::max(kFewest, best.length()) &&
         later_[row][index].gain < std::max(kToTellApart, kKept * best.gain);
}

void Suspicion::offer_own_noise(std::size_t index, double gain) {
  own_noise_[index] = std::max(own_noise_[index], gain);
}

// That it repeats one reading is unlikely whatever its level; that this level is another one is
// unlikely in addition.
double Suspicion::gain(FaultKind kind, std::size_t index) const {
  const auto strongest = [&](FaultKind of) {
    return strongest_[static_cast<std::size_t>(of)][index].gain;
  };
  const double step = came_back(index) ? 0.0 : strongest(FaultKind::kStep);
  if (kind == FaultKind::kStep) return step;
  const double alone = strongest(kind);
  return kind == FaultKind::kStuck && alone > 0.0 ? alone + step : alone;
}

Fault Suspicion::verdict() const {
  const auto gain_of = [&](std::size_t k, std::size_t i) {
    return gain(static_cast<FaultKind>(k), i);
  };
  std::size_t kind = 0;
  std::size_t worst = 0;
  for (std::size_t k = 0; k < kFaultKinds; ++k) {
    for (std::size_t i = 0; i < sensors_.size(); ++i) {
      if (gain_of(k, i) > gain_of(kind, worst)) kind = k, worst = i;
    }
  }
  std::vector<std::size_t> named;
  for (std::size_t i = 0; i < sensors_.size(); ++i) {
    if (gain_of(kind, i) > gain_of(kind, worst) - kToTellApart) named.push_back(i);
  }
  if (named.size() > 1 && static_cast<FaultKind>(kind) == FaultKind::kNoisy) {
    worst = *std::max_element(named.begin(), named.end(), [&](std::size_t a, std::size_t b) {
      return own_noise_[a] < own_noise_[b];
    });
    std::erase_if(named,
                  [&](std::size_t i) { return own_noise_[i] <= own_noise_[worst] - kToTellApart; });
  }
  const Evidence& best = strongest_[kind][worst];
  Fault out{static_cast<FaultKind>(kind),
            {},
            begun_[kind][worst].onset,
            detected_,
            0,
            best.size,
            best.size_error,
            gain_of(kind, worst)};
  for (const std::size_t i : named) out.sensors.push_back(sensors_[i]);
  if (out.kind == FaultKind::kNoisy && is_over(worst)) out.end = best.end;
  return out;
}

}  // namespace imunoise
