#pragma once

// What exporting knows of a program that takes noise values. One consumer is one file in
// consumers/ and one line in known_consumers.cpp.

#include <functional>
#include <string>
#include <string_view>
#include <vector>

#include "study/export/imu_noise.h"
#include "study/export/whole/state_space.h"

namespace imunoise::study {

/// One key of a consumer's file with its value for each axis: one for all, or three.
struct Field {
  std::string key;
  std::vector<Bounded> values;
  std::string unit;
  std::string formula;  ///< from N, K and f, with numbers: "N·√(2f), f = 200 Hz"
};

/// What the writer of a file gets.
struct Sheet {
  std::vector<std::string> heading;  ///< lines of a comment: source, hash, models, what is left out
  std::vector<Field> fields;
  ImuNoise imu;  ///< after --axis
  std::vector<StateSpace>
      systems;  ///< of Holding::kStates: one an axis, or an array and its virtual sensor
};

/// What a consumer takes of a model.
enum class Holding {
  kDensities,  ///< N, K, and a Markov process where takes_markov says so
  kTerms,      ///< every term, by its coefficients
  kStates,     ///< every term, as matrices of a filter; arrays too
};

/// A program, and how its files say noise.
struct Consumer {
  std::string_view name;   ///< of --to: "kalibr"
  std::string_view title;  ///< "Kalibr"
  std::string_view file;   ///< customary name of the file, or of what holds the values
  std::string_view holds;  ///< what it can express: "white noise and random walk"
  Holding holding = Holding::kDensities;
  AxisRule axes = AxisRule::kWorst;  ///< kEach where its file has a value for each axis
  bool takes_walk = true;            ///< it has a place for K
  bool takes_markov = false;         ///< a bias may be a Markov process
  bool one_time = false;             ///< and all biases have the same correlation time
  bool takes_zero = true;            ///< false: it refuses values of zero
  std::string_view remark{};         ///< what its user has to know; stands in the file
  double step = 0.0;                 ///< s, of its filter where values depend on it; else 0
  std::vector<Field> (*fields)(const ImuNoise& imu, double step) = nullptr;  ///< of kDensities
  /// Null: the program has no place for noise values, and `remark` says so.
  std::string (*write)(const Sheet& sheet) = nullptr;
};

/// Adds a field with `value` of every axis of a sensor; nothing where it has no axes. Intervals
/// follow from those of N and K: value() has to grow with both.
void add_field(std::vector<Field>& to, std::string key, const SensorNoise& sensor,
               const std::function<double(const AxisNoise&)>& value, std::string unit,
               std::string formula);

// Values that several consumers take.
double density(const AxisNoise& axis);  ///< N
double walk(const AxisNoise& axis);     ///< K
/// "f = 200 Hz": the rate in a formula.
std::string rate_words(const SensorNoise& sensor);

/// Sampling rate of the gyro, or of the accelerometer where there is none (Hz).
double rate_of(const ImuNoise& imu);

/// The process that stands for a wandering bias where a consumer takes a Markov process alone: the
/// random walk as a Markov process of kEndless, or the slowest Markov process of a model without
/// random walk. {0, kEndless} where the model has neither.
Markov markov_bias(const AxisNoise& axis);
/// Correlation time (s) of a Markov process that is a random walk for all practical purposes: over
/// an hour its variance is 0.2 % less.
inline constexpr double kEndless = 1e6;

/// "key: value", "key: [x, y, z]", with '#' in front of comments.
std::string yaml(const Sheet& sheet);
/// The same indented under `root`.
std::string yaml_under(std::string_view root, const Sheet& sheet);
/// Every line of the heading behind `prefix`.
std::string commented(const Sheet& sheet, std::string_view prefix);
/// The heading as a member of a JSON object: `"comment": ["...", ...],` and a line end.
std::string json_comment(const Sheet& sheet, std::string_view indent);
/// "rad/s/√Hz; N (1.1e-4 … 1.3e-4)": what stands beside a value.
std::string field_words(const Field& field);
/// Values as programs read them: "0.00012" or "[1, 2, 3]" with the brackets and separator given.
std::string value_list(const Field& field, std::string_view open = "[",
                       std::string_view separator = ", ", std::string_view close = "]");

}  // namespace imunoise::study
