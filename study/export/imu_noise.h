#pragma once

// The noise of an IMU in the terms that other programs take: N, K and one slow Markov process an
// axis, beside the whole model.

#include <optional>
#include <string>
#include <vector>

#include "core/model/model.h"
#include "core/support/units.h"
#include "study/export/power_on.h"

namespace imunoise::study {

/// A value with its confidence interval.
struct Bounded {
  double value = 0.0;
  double lower = 0.0;
  double upper = 0.0;
  /// False where the source states no interval.
  bool bounded() const { return lower < upper; }
};

/// First-order Gauss-Markov process.
struct Markov {
  double sigma = 0.0;  ///< stationary standard deviation, unit of the channel
  double tc = 0.0;     ///< correlation time, s
};

/// A coefficient of a term, in SI and as data sheets print it.
struct CoefficientRow {
  std::string term;    ///< "AR1"
  std::string symbol;  ///< "N", "K", "T", ...
  std::string title;   ///< "angle random walk"
  Bounded value;       ///< SI
  std::string unit;
  std::string datasheet_unit;  ///< empty: none is customary
  double to_datasheet = 1.0;
};

/// The noise of one axis. All in SI, densities in continuous time, one-sided in the sense of IEEE
/// Std 952: σ² of the integral grows by N² a second.
struct AxisNoise {
  std::string channel;
  char axis = ' ';  ///< 'x', 'y', 'z'; ' ' where the name of the channel says none
  Hertz rate;
  Model noise;                               ///< the whole model, without effects
  std::vector<ParameterDraw> draws;          ///< parameters that differ between replicates
  std::optional<double> p_value;             ///< that it fits; unset: not tested
  double confidence = 0.95;                  ///< of the intervals
  Bounded n;                                 ///< unit/√Hz; 0: the model has no white noise
  Bounded k;                                 ///< unit/s/√Hz; 0: the model has no random walk
  bool hidden_walk = false;                  ///< the data do not show it: k.upper bounds it
  std::vector<CoefficientRow> coefficients;  ///< of all terms
  std::optional<Markov> markov;              ///< the slowest Markov process of at least kSlowest
  std::string markov_words;                  ///< term_words() of that process; empty: there is none
  std::string walk_words;                    ///< and of the random walk
  std::vector<std::string> left_out;         ///< terms that N and K do not hold, in words
  std::vector<std::string> effects;          ///< of the model beside its noise, in the grammar
  std::optional<Model> bound;        ///< that stands for the model where it is a conservative one
  std::vector<std::string> remarks;  ///< how N and K differ from the model's, in words
};

/// A Markov process with a shorter correlation time (s) is bandwidth, not a bias that wanders.
inline constexpr double kSlowest = 0.1;

/// The axes of one quantity; none where the source has no such channel.
struct SensorNoise {
  Quantity quantity = Quantity::kUnknown;
  std::vector<AxisNoise> axes;
  /// How the axes of the source became these; a phrase: "worst of gyro_x, gyro_y, gyro_z".
  std::string reduction{};
};

struct ImuNoise {
  SensorNoise gyro{Quantity::kAngularRate, {}};
  SensorNoise accelerometer{Quantity::kAcceleration, {}};
};

/// N, K, the slowest Markov process and the words for all other terms of a noise model. No
/// intervals.
AxisNoise axis_noise(std::string channel, Quantity quantity, Hertz rate, Model noise);

/// "first-order Markov noise: 20.3 °/h, 4.89 s": a term in the units of data sheets.
std::string term_words(const Process& process, Quantity quantity, Hertz rate);

enum class AxisRule {
  kEach,   ///< three axes as they are
  kWorst,  ///< the largest N, the largest K
  kMean,   ///< root mean squares of N and K
};

/// One axis for all (kWorst, kMean), or three in the order x, y, z (kEach). A sensor with fewer
/// than three axes gives its worst for all three.
SensorNoise reduced(const SensorNoise& sensor, AxisRule rule);

}  // namespace imunoise::study
