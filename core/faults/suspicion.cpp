#include "core/faults/suspicion.h"

#include <algorithm>
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
}

void Suspicion::offer(FaultKind kind, std::size_t index, const Evidence& evidence) {
  const auto row = static_cast<std::size_t>(kind);
  keep_stronger(strongest_[row][index], evidence);
  if (evidence.onset <= detected_) keep_stronger(begun_[row][index], evidence);
}

void Suspicion::offer_own_noise(std::size_t index, double gain) {
  own_noise_[index] = std::max(own_noise_[index], gain);
}

Fault Suspicion::verdict() const {
  std::size_t kind = 0;
  std::size_t worst = 0;
  for (std::size_t k = 0; k < kFaultKinds; ++k) {
    for (std::size_t i = 0; i < sensors_.size(); ++i) {
      if (strongest_[k][i].gain > strongest_[kind][worst].gain) kind = k, worst = i;
    }
  }
  const auto suspects = [&](const auto& gain) {
    std::vector<std::size_t> out;
    for (std::size_t i = 0; i < sensors_.size(); ++i) {
      if (gain(i) > gain(worst) - kToTellApart) out.push_back(i);
    }
    return out;
  };
  std::vector<std::size_t> named =
      suspects([&](std::size_t i) { return strongest_[kind][i].gain; });
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
            best.size,
            best.size_error,
            best.gain};
  for (const std::size_t i : named) out.sensors.push_back(sensors_[i]);
  return out;
}

}  // namespace imunoise
