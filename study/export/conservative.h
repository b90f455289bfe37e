#pragma once

#include <Eigen/Core>

#include "core/model/model.h"

namespace imunoise::study {

/// The times over which a filter relies on the sensor alone, s.
struct Horizon {
  double begin = 0.1;
  double end = 10.0;
};

/// White noise and a random walk that stand for a whole model.
struct WhiteAndWalk {
  double n = 0.0;      ///< unit/√Hz
  double k = 0.0;      ///< unit/s/√Hz
  double most = 1.0;   ///< largest ratio of its integrated error to the model's over the horizon
  double usual = 1.0;  ///< root mean square of that ratio over log τ
};

/// Averaging times of a horizon in samples, dense enough that a smooth curve cannot pass between
/// them (32 an octave): at least one, none below one sample.
Eigen::ArrayXd horizon_samples(Hertz rate, const Horizon& horizon);

/// The error of an integral over τ whose bias was measured over the τ before has the standard
/// deviation τ·√2·σ_Allan(τ). The smallest WN + RW whose error is nowhere below that of `allan`
/// (Allan variance at `samples`): it minimises the mean ratio of squared errors over log τ.
/// Overbounding by the Allan variance: Lethander & Taylor, NAVIGATION 70(3), 2023,
/// doi 10.33012/navi.563. Precondition: variances > 0, one each.
WhiteAndWalk smallest_bound(const Eigen::ArrayXd& samples, const Eigen::ArrayXd& allan, Hertz rate);

/// The same of a model.
WhiteAndWalk smallest_bound(const Model& noise, Hertz rate, const Horizon& horizon);

/// Largest ratio of the integrated error of `noise` to that of `held` over the horizon.
/// Precondition: `held` has noise at all scales.
double underestimate(const Model& noise, const Model& held, Hertz rate, const Horizon& horizon);

}  // namespace imunoise::study
