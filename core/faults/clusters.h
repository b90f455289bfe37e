#pragma once

#include <Eigen/Core>

namespace imunoise {

/// The threshold h at which a bank of filters on white noise cries wolf `rate` times a sample.
/// `filters` holds unit rows, each over `dimension`-dimensional samples, the newest first; an alarm
/// is |output| > h, and alarms that share samples count once. By the identity
///   P(∪ A) = Σ_A P(A) E[1 / number of events that happen | A]
/// (Naiman & Priebe 2001) with the expectation from 1,000 seeded draws: good to about 2 % of the
/// rate however small it is. Precondition: rate in (0, 1).
double cluster_threshold(const Eigen::MatrixXd& filters, Eigen::Index dimension, double rate);

}  // namespace imunoise
