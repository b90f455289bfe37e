#pragma once

#include <cstddef>
#include <optional>
#include <vector>

#include "core/faults/noise_watch.h"
#include "core/faults/step_watch.h"
#include "core/faults/stuck_watch.h"
#include "core/faults/suspicion.h"
#include "core/support/units.h"

namespace imunoise {

struct FaultOptions {
  /// Of the whole detector, in operation: all sensors, kinds and durations.
  double false_alarms_per_hour = 0.1;
  /// Samples that the model was fitted to: the history that predictions use is no longer.
  std::size_t longest = 100'000;
  /// Least difference between two readings, one a sensor; empty: all are continuous.
  std::vector<double> resolution{};
  /// How far off the model may be.
  ModelDoubt doubt{};
};

/// Names the sensor of an array that steps, sticks or grows noisy, reading by reading, in bounded
/// memory. Steps and noise are sought in the parity of the sensors, which no motion that all of
/// them see can disturb, whitened under the array's model (InnovationFilter): steps by generalised
/// likelihood ratio at block lengths 1, 2, 4 .., noise by the variance along each sensor's
/// direction. A sensor sticks when it repeats one reading. The false alarms that are allowed are
/// shared equally by the three kinds, and among steps by the block lengths. After an alarm a few
/// more readings are awaited before the kind and the sensor with the largest gain in log-likelihood
/// are named. After a step, or noise that is over, all levels are learnt anew; a sensor that sticks
/// or stays noisy is watched no longer. Deterministic; copies go on independently.
class FaultDetector {
 public:
  /// Readings after a start before anything but sticking is watched for.
  static constexpr std::size_t kWarmUp = InnovationFilter::kHistory + StepWatch::kMostBlocks;

  /// Precondition: at least two sensors, parity_is_noisy(), false alarms and rate above 0.
  FaultDetector(ArrayModel model, Hertz rate, FaultOptions options);

  /// Takes one reading of every sensor (I). A fault that was decided with it.
  std::optional<Fault> feed(const Eigen::Ref<const Eigen::VectorXd>& readings);
  /// At the end of the readings: the fault that was still awaiting evidence.
  std::optional<Fault> finish();
  /// Begins a new recording with the sensors that are left; readings count from 0 again.
  void restart();

  /// Sensors that are still watched; none when fewer than two are left.
  const std::vector<Eigen::Index>& watched() const { return used_; }
  /// Repetitions after which each of watched() is called stuck; 0: its resolution is too coarse.
  std::vector<std::size_t> repetitions() const;

 private:
  void design();
  void begin();
  std::size_t step_alarm(const Eigen::VectorXd& readings);
  std::size_t noise_alarm(const Eigen::VectorXd& readings);
  std::size_t stuck_alarm(const Eigen::Ref<const Eigen::VectorXd>& readings);
  void gather();
  std::optional<Fault> decide();

  // What follows the readings. Designed once for a set of sensors; a copy of it begins anew.
  struct Watches {
    std::vector<StepWatch> steps;       // of block lengths 1, 2, 4 ..
    std::vector<InnovationStream> own;  // of each sensor by itself
    std::vector<NoiseWatch> noise;      // of the parity, and of the sensors by themselves
    std::vector<StuckWatch> stuck;      // one
  };

  ArrayModel model_;
  Hertz rate_;
  FaultOptions options_;
  std::vector<Eigen::Index> used_;
  Eigen::MatrixXd parity_;
  Watches designed_;
  Watches now_;
  Eigen::VectorXd first_;              // reading, subtracted from all
  std::vector<Eigen::VectorXd> half_;  // the first half of each longer block
  std::size_t blocks_ended_ = 0;       // lengths of which a block ended with the last reading
  bool noise_seen_ = false;            // with the last reading
  std::size_t learnt_ = 0;             // readings since all was learnt anew
  std::size_t taken_ = 0;              // readings of this recording
  std::optional<Suspicion> suspicion_;
};

}  // namespace imunoise
