#include "core/faults/noise_watch.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <random>
#include <utility>

#include "core/support/distributions.h"
#include "core/support/random.h"
#include "core/support/roots.h"

namespace imunoise {
namespace {

constexpr double kMostOftenAWindow = 0.01;  // no window alarms by chance more often than this
constexpr std::uint64_t kSeed = 20261121;
constexpr std::size_t kDraws = 300;
constexpr int kRounds = 2;
constexpr std::size_t kReach = 3;  // doublings of a window within which alarms count as one

// Probability of an alarm of one window of each length, given that of windows of one sample.
double chance_of(std::size_t length, double share) {
  return std::min(kMostOftenAWindow, share * static_cast<double>(std::size_t{1} << length));
}

std::vector<double> thresholds_of(double share) {
  std::vector<double> out;
  for (std::size_t w = 0; w < NoiseWatch::kWindows; ++w) {
    out.push_back(
        chi_square_quantile(1.0 - chance_of(w, share), static_cast<double>(std::size_t{1} << w)));
  }
  return out;
}

// The threshold of a sum of `samples` squares that chance exceeds as often, where their variance is
// known with so many degrees of freedom.
double as_known(double threshold, double samples, double degrees) {
  constexpr double kMost = 50.0;  // of its logarithm
  const double log_tail = log_chi_square_tail(threshold, samples);
  const auto beyond = [&](double log_ratio) {
    return log_f_tail(std::exp(log_ratio), samples, degrees) - log_tail;
  };
  return beyond(kMost) > 0.0 ? std::numeric_limits<double>::infinity()
                             : samples * std::exp(root_between(beyond, 0.0, kMost));
}

// E[1 / number of windows that alarm together with one], over all lengths and sensors: draws white
// noise that drives one window beyond its threshold.
double mean_share(const Eigen::MatrixXd& directions, double share) {
  const std::vector<double> thresholds = thresholds_of(share);
  RandomStream random(kSeed);
  std::uniform_real_distribution<double> uniform(1e-12, 1.0);
  double sum = 0.0;
  for (std::size_t draw = 0; draw < kDraws; ++draw) {
    const std::size_t length = draw % NoiseWatch::kWindows;
    const std::size_t top = std::min(NoiseWatch::kWindows - 1, length + kReach);
    const auto sensor = static_cast<Eigen::Index>(draw / NoiseWatch::kWindows) % directions.rows();
    const auto size = static_cast<Eigen::Index>(std::size_t{1} << length);
    Eigen::MatrixXd noise(directions.cols(), Eigen::Index{1} << top);
    for (double& x : noise.reshaped()) x = random.normal();
    auto window =
        noise.middleCols(size * (static_cast<Eigen::Index>(draw) % (noise.cols() / size)), size);
    const Eigen::RowVectorXd along = directions.row(sensor) * window;
    const double reached = chi_square_quantile(
        1.0 - chance_of(length, share) * uniform(random.engine()), static_cast<double>(size));
    window += directions.row(sensor).transpose() * along *
              (std::sqrt(reached / along.squaredNorm()) - 1.0);
    Eigen::MatrixXd sums = (directions * noise).cwiseAbs2();
    Eigen::Index beyond = 0;
    for (std::size_t w = 0;; ++w) {
      beyond += (sums.array() > thresholds[w]).count();
      if (w == top) break;
      const Eigen::Index half = sums.cols() / 2;
      const Eigen::MatrixXd pairs =
          sums(Eigen::all, Eigen::seqN(0, half, 2)) + sums(Eigen::all, Eigen::seqN(1, half, 2));
      sums = pairs;
    }
    sum += 1.0 / static_cast<double>(std::max<Eigen::Index>(1, beyond));
  }
  return sum / static_cast<double>(kDraws);
}

}  // namespace

NoiseWatch::NoiseWatch(Eigen::MatrixXd directions)
    : directions_(std::move(directions)),
      thresholds_(kWindows, std::numeric_limits<double>::infinity()),
      waiting_(Eigen::MatrixXd::Zero(directions_.rows(), kWindows)),
      ended_(Eigen::MatrixXd::Zero(directions_.rows(), kWindows)) {}

NoiseWatch::NoiseWatch(Eigen::MatrixXd directions, double degrees, double false_alarms)
    : NoiseWatch(std::move(directions)) {
  const double each =
      false_alarms / (static_cast<double>(kWindows) * static_cast<double>(directions_.rows()));
  double share = each;
  for (int round = 0; round < kRounds; ++round) share = each / mean_share(directions_, share);
  thresholds_ = thresholds_of(share);
  if (!std::isfinite(degrees)) return;
  for (std::size_t w = 0; w < kWindows; ++w)
    thresholds_[w] = as_known(thresholds_[w], static_cast<double>(std::size_t{1} << w), degrees);
}

bool NoiseWatch::feed(const Eigen::Ref<const Eigen::VectorXd>& innovation) {
  bool beyond = false;
  ended_.col(0) = (directions_ * innovation).cwiseAbs2();
  lengths_ = 0;
  for (std::size_t number = seen_++;; number /= 2) {
    const auto at = static_cast<Eigen::Index>(lengths_);
    beyond = beyond || ended_.col(at).maxCoeff() > thresholds_[lengths_];
    if (++lengths_ == kWindows) break;
    if (number % 2 == 0) {
      waiting_.col(at) = ended_.col(at);
      break;
    }
    ended_.col(at + 1) = waiting_.col(at) + ended_.col(at);
  }
  return beyond;
}

NoiseEvidence NoiseWatch::strongest(Eigen::Index sensor) const {
  NoiseEvidence best;
  for (std::size_t w = 0; w < lengths_; ++w) {
    const std::size_t samples = std::size_t{1} << w;
    const auto n = static_cast<double>(samples);
    const double ratio = ended_(sensor, static_cast<Eigen::Index>(w)) / n;
    const double gain = ratio > 1.0 ? 0.5 * n * (ratio - 1.0 - std::log(ratio)) : 0.0;
    if (gain > best.gain) best = {gain, ratio, samples};
  }
  return best;
}

}  // namespace imunoise
