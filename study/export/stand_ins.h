#pragma once

#include <string>

#include "study/export/conservative.h"
#include "study/export/consumer.h"

namespace imunoise::study {

/// What a consumer will think the axis is.
Model held_by(const Consumer& to, const AxisNoise& axis);

/// "0.1 to 10 s".
std::string horizon_words(const Horizon& horizon);

/// Where a bias may be a Markov process: the random walk or the slowest Markov process, whichever
/// leaves less of the model out.
void choose_bias(AxisNoise& axis, const Consumer& to, const Horizon& horizon);

/// N and K for a consumer that needs values the model does not have: the least that, beside what
/// the model has, bound its integrated error over the horizon.
void fill(AxisNoise& axis, const Consumer& to, const Horizon& horizon);

/// N and K where a consumer refuses the 0 that they are: so small that they hardly count.
void make_positive(AxisNoise& axis, const Consumer& to, const Horizon& horizon);

/// One correlation time for all biases, for a consumer that has no place for more: of those that
/// the axes have, the one that overstates the integrated error least, with the least σ that bounds
/// it on each axis.
void share_time(ImuNoise& imu, const Consumer& to, const Horizon& horizon);

}  // namespace imunoise::study
