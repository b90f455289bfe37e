#include "core/regression/modulation.h"

#include <algorithm>
#include <cmath>

namespace imunoise {
namespace {

using Index = Eigen::Index;

constexpr Index kStretch = 32;  // samples

// Short stretches, in which the course hardly moves, stand for their samples.
struct Stretches {
  Eigen::ArrayXd power;   // sum of squared innovations
  Eigen::ArrayXd course;  // mean, in its unit
};

Stretches stretches_of(const VarianceCourse& course, const Innovations& innovations) {
  Index count = 0;
  for (const Eigen::VectorXd& y : innovations.white) count += y.size() / kStretch;
  Stretches out{Eigen::ArrayXd(count), Eigen::ArrayXd(count)};
  Index place = 0;
  for (std::size_t i = 0; i < innovations.white.size(); ++i) {
    const Eigen::VectorXd& y = innovations.white[i];
    const std::size_t k = innovations.replicates[i];
    const SharedVector& c = course[k];
    for (Index t = 0; t + kStretch <= y.size(); t += kStretch, ++place) {
      out.power(place) = y.segment(t, kStretch).squaredNorm();
      out.course(place) = course.level(k) + c.segment(t, kStretch).mean();
    }
  }
  return out;
}

// Log-likelihood of variances exp(log_variance) over that of variances 1.
double gain_of(const Eigen::ArrayXd& log_variance, const Eigen::ArrayXd& power) {
  return -0.5 *
         (static_cast<double>(kStretch) * log_variance + power * ((-log_variance).exp() - 1.0))
             .sum();
}

}  // namespace

Modulation modulation_by(const VarianceCourse& course, const Innovations& innovations) {
  const Stretches all = stretches_of(course, innovations);
  if (all.power.size() == 0) return {};
  Modulation out;
  out.mean = all.course.mean();
  const Eigen::ArrayXd centred = all.course - out.mean;
  out.deviation = std::sqrt(centred.square().mean());
  if (!(out.deviation > 0.0)) return {};
  const Eigen::ArrayXd c = centred / out.deviation;
  // Newton's method; the level is at its best for every slope.
  for (int step = 0; step < 20; ++step) {
    const Eigen::ArrayXd share = (-out.slope * c).exp() * all.power;
    const double mean = (share * c).sum() / share.sum();
    const double spread = (share * c.square()).sum() / share.sum() - mean * mean;
    const double move = std::clamp(mean / spread, -1.0, 1.0);
    out.slope += move;
    if (std::abs(move) < 1e-9) break;
  }
  const auto stretch = static_cast<double>(kStretch);
  out.level = ((-out.slope * c).exp() * all.power).mean() / stretch;
  out.error = std::sqrt(2.0 / (stretch * static_cast<double>(c.size())));
  // Over the best constant level: that is the noise model's to find.
  const double constant = std::log(all.power.mean() / stretch);
  out.log_likelihood = gain_of(std::log(out.level) + out.slope * c, all.power) -
                       gain_of(Eigen::ArrayXd::Constant(c.size(), constant), all.power);
  return out;
}

void take_out(const Modulation& modulation, const VarianceCourse& course,
              Innovations& innovations) {
  for (std::size_t i = 0; i < innovations.white.size(); ++i)
    take_out(modulation, course, innovations.replicates[i], innovations.white[i]);
}

void take_out(const Modulation& modulation, const VarianceCourse& course, std::size_t replicate,
              Eigen::VectorXd& white) {
  const double from = modulation.mean - course.level(replicate);
  for (Index t = 0; t < white.size(); t += kStretch) {
    const Index size = std::min(kStretch, white.size() - t);
    const double at = (course[replicate].segment(t, size).mean() - from) / modulation.deviation;
    white.segment(t, size) /= std::sqrt(modulation.level * std::exp(modulation.slope * at));
  }
}

double predicted_gain(const Modulation& modulation, const VarianceCourse& course,
                      const Innovations& innovations) {
  const Stretches all = stretches_of(course, innovations);
  const Eigen::ArrayXd c = (all.course - modulation.mean) / modulation.deviation;
  // Far beyond the course that it was estimated from, a slope tells nothing: it counts less the
  // more its error makes of the logarithm there.
  const Eigen::ArrayXd told = modulation.slope * c / (1.0 + (modulation.error * c).square());
  return gain_of(std::log(modulation.level) + told, all.power);
}

}  // namespace imunoise
