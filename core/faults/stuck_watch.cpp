#include "core/faults/stuck_watch.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <utility>

#include "core/faults/innovations.h"

namespace imunoise {
namespace {

constexpr std::size_t kMostRepetitions = 10'000;
constexpr double kContinuous = 1e-6;  // resolution over noise that counts as none

}  // namespace

StuckWatch::StuckWatch(const ArrayModel& model, std::vector<Eigen::Index> used,
                       const std::vector<double>& resolution, double false_alarms)
    : used_(std::move(used)),
      repeated_(used_.size(), 0),
      before_(Eigen::VectorXd::Constant(model.sensors, std::numeric_limits<double>::quiet_NaN())) {
  const double wanted = std::log(false_alarms / static_cast<double>(used_.size()));
  for (const Eigen::Index sensor : used_) {
    const InnovationFilter filter(model, sensor_row(model.sensors, sensor), 1);
    const Eigen::VectorXd& variances = filter.conditional_variances();
    const double step = std::max(resolution[static_cast<std::size_t>(sensor)],
                                 kContinuous * std::sqrt(variances(0)));
    const double rounding = step * step / 12.0;  // its variance
    double log_chance = 0.0;
    std::size_t n = 0;
    while (n < kMostRepetitions && (n < kFewest || log_chance > wanted)) {
      const auto known = std::min(static_cast<Eigen::Index>(n), InnovationFilter::kHistory - 1);
      const double unrounded = std::max(0.0, variances(known) - rounding);
      log_chance += std::log(std::erf(step / std::sqrt(8.0 * unrounded)));
      ++n;
    }
    most_.push_back(n < kMostRepetitions ? n : 0);
    gain_.push_back(-log_chance / static_cast<double>(n));
  }
}

bool StuckWatch::feed(const Eigen::Ref<const Eigen::VectorXd>& readings) {
  bool stuck = false;
  for (std::size_t i = 0; i < used_.size(); ++i) {
    repeated_[i] = readings(used_[i]) == before_(used_[i]) ? repeated_[i] + 1 : 0;
    stuck = stuck || (most_[i] > 0 && repeated_[i] == most_[i]);
  }
  before_ = readings;
  return stuck;
}

bool StuckWatch::in_doubt() const {
  for (std::size_t i = 0; i < used_.size(); ++i) {
    if (2 * repeated_[i] >= most_[i] && repeated_[i] < most_[i]) return true;
  }
  return false;
}

std::size_t StuckWatch::repeated(Eigen::Index index) const {
  return repeated_[static_cast<std::size_t>(index)];
}

double StuckWatch::gain(Eigen::Index index) const {
  const auto i = static_cast<std::size_t>(index);
  if (most_[i] == 0 || repeated_[i] < most_[i]) return 0.0;
  return gain_[i] * static_cast<double>(repeated_[i]);
}

}  // namespace imunoise
