#pragma once

#include <vector>

#include "core/effect/subject.h"
#include "core/support/linear_algebra.h"

namespace imunoise {

/// Samples of some replicates as independent numbers of variance 1 (mean zero), in the order of
/// time.
struct Innovations {
  std::vector<std::size_t> replicates;  ///< by their numbers in the subject
  std::vector<Eigen::VectorXd> white;   ///< one each
};

/// How the power of the noise follows a course c: variance · level · exp(b · (c - mean)/deviation).
struct Modulation {
  double slope = 0.0;           ///< b, per standard deviation of the course
  double error = 0.0;           ///< standard error of b
  double level = 1.0;           ///< at the course's mean
  double mean = 0.0;            ///< of the course, in its unit
  double deviation = 1.0;       ///< of the course, in its unit
  double log_likelihood = 0.0;  ///< nats gained where it was estimated
};

/// The modulation that explains some innovations best.
Modulation modulation_by(const VarianceCourse& course, const Innovations& innovations);

/// Divides innovations by what a modulation makes of their deviation.
void take_out(const Modulation& modulation, const VarianceCourse& course, Innovations& innovations);
/// The same of one replicate.
void take_out(const Modulation& modulation, const VarianceCourse& course, std::size_t replicate,
              Eigen::VectorXd& white);

/// What a modulation gains on innovations that it was not estimated from, nats.
double predicted_gain(const Modulation& modulation, const VarianceCourse& course,
                      const Innovations& innovations);

}  // namespace imunoise
