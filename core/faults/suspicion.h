#pragma once

#include <Eigen/Core>
#include <array>
#include <cstddef>
#include <vector>

namespace imunoise {

enum class FaultKind {
  kStep,   ///< its level changed
  kNoisy,  ///< its white noise grew
  kStuck,  ///< it repeats one reading
};
inline constexpr std::size_t kFaultKinds = 3;

struct Fault {
  FaultKind kind = FaultKind::kStep;
  std::vector<Eigen::Index> sensors;  ///< one; several where the readings cannot tell which of them
  std::size_t onset = 0;     ///< the first reading that it changed, estimated (stuck: exact)
  std::size_t detected = 0;  ///< the reading with which the alarm was raised
  /// Of noise: the reading before which it was over, where that was before the verdict; 0 else.
  std::size_t end = 0;
  /// Of a step: its height; of noise: the standard deviation of what was added to each reading; of
  /// a stuck sensor: how often it repeated its reading. In the sensors' unit.
  double size = 0.0;
  double size_error = 0.0;  ///< standard error of a step's height, 0 else
  double gain = 0.0;        ///< of the log-likelihood over "nothing is wrong"
};

/// What speaks for one fault of one sensor.
struct Evidence {
  double gain = 0.0;  ///< of the log-likelihood
  double size = 0.0;
  double size_error = 0.0;
  std::size_t onset = 0;
  std::size_t end = 0;  ///< the reading after the last one that it looked at

  std::size_t length() const { return end - onset; }
};

/// The evidence that gathers between an alarm and the verdict.
class Suspicion {
 public:
  /// `decide` is the reading after which the verdict is due.
  Suspicion(std::vector<Eigen::Index> sensors, std::size_t detected, std::size_t decide);

  /// Keeps the strongest evidence for a fault of sensor `sensors[index]`. Evidence that begins
  /// after the alarm tells which fault it is, but not when the fault began.
  void offer(FaultKind kind, std::size_t index, const Evidence& evidence);
  /// The same for its own readings being noisier, motion included: it decides between sensors that
  /// their parity cannot tell apart.
  void offer_own_noise(std::size_t index, double gain);
  bool due(std::size_t reading) const { return reading >= decide_; }
  /// The kind and sensor with the largest gain, and the sensors within 3 nats of it. A level that
  /// came back is no step.
  Fault verdict() const;

 private:
  void follow(FaultKind kind, std::size_t index, const Evidence& evidence);
  double gain(FaultKind kind, std::size_t index) const;
  bool came_back(std::size_t index) const;
  bool is_over(std::size_t index) const;

  std::vector<Eigen::Index> sensors_;
  std::size_t detected_;
  std::size_t decide_;
  using EvidenceTable = std::array<std::vector<Evidence>, kFaultKinds>;  // kinds × sensors
  EvidenceTable strongest_;
  EvidenceTable begun_;  // the strongest that began by the alarm
  // What came after the strongest: of steps, the last that looked twice as long at the same one; of
  // noise, the strongest that began when that had ended.
  EvidenceTable later_;
  std::size_t now_ = 0;  // one past the last reading that was looked at
  std::vector<double> own_noise_;
};

}  // namespace imunoise
