#include "core/effects/distributions/wandering_power.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <numeric>

#include "core/support/distributions.h"
#include "core/support/linear_algebra.h"
#include "core/support/parallel.h"

namespace imunoise {
namespace {

using Index = Eigen::Index;

constexpr int kMostPlaces = 128;
using Chances = Eigen::Matrix<float, Eigen::Dynamic, 1, Eigen::ColMajor, kMostPlaces, 1>;
using Places = Eigen::Array<float, Eigen::Dynamic, 1, Eigen::ColMajor, kMostPlaces, 1>;

constexpr double kReach = 4.0;            // of the grid, standard deviations
constexpr double kLeastDeviation = 0.01;  // deviation
constexpr double kMostDeviation = 4.0;    // deviation
constexpr double kShortestTau = 2.0;      // correlation time, samples

// Powers at equal distances of their logarithm, over their mean, and how they follow each other
// from one stretch to the next.
class WanderGrid {
 public:
  // `level`: mean power.
  WanderGrid(double tau, double deviation, double level, Index stretch) {
    const double stays = std::exp(-static_cast<double>(stretch) / tau);
    const double step = std::sqrt(1.0 - stays * stays);
    constexpr double kFinest = 2.0 * kReach / (kMostPlaces - 2);
    constexpr double kCoarsest = 0.4;
    const auto count =
        static_cast<Index>(std::ceil(2.0 * kReach / std::clamp(step, kFinest, kCoarsest))) + 1;
    const double apart = 2.0 * kReach / static_cast<double>(count - 1);
    const Eigen::ArrayXd place = Eigen::ArrayXd::LinSpaced(count, -kReach, kReach);
    const Eigen::ArrayXd log_power =
        deviation * place - 0.5 * deviation * deviation + std::log(level);
    logarithm_ = log_power.cast<float>();
    inverse_ = (-log_power).exp().cast<float>();
    anywhere_ = normal_chances(place, 0.0, 1.0);
    constexpr double kFarthest = 4.5;  // steps
    const double spread = std::max(step, 0.6 * apart);
    const auto width =
        std::min(count, 2 * static_cast<Index>(std::ceil(kFarthest * spread / apart)) + 1);
    moves_.resize(width, count);
    to_.resize(static_cast<std::size_t>(count));
    for (Index i = 0; i < count; ++i) {
      const auto middle = std::lround((stays * place(i) + kReach) / apart);
      const Index to = std::clamp<Index>(middle - width / 2, 0, count - width);
      to_[static_cast<std::size_t>(i)] = to;
      moves_.col(i) = normal_chances(place.segment(to, width), stays * place(i), spread);
    }
  }

  const Chances& anywhere() const { return anywhere_; }  ///< how often the power is at each place
  const Places& inverse() const { return inverse_; }     ///< of the power at each

  // To the next stretch. Nothing is impossible: a sample may be where none is expected.
  void move(Chances& chances) const {
    constexpr float kLeast = 1e-20F;
    Chances after = Chances::Constant(chances.size(), kLeast);
    for (Index i = 0; i < chances.size(); ++i) {
      if (chances(i) > kLeast)
        after.segment(to_[static_cast<std::size_t>(i)], moves_.rows()) +=
            chances(i) * moves_.col(i);
    }
    chances = after;
  }

  // Some places that follow each other.
  struct Range {
    Index first;
    Index size;
  };
  Range whole() const { return {0, logarithm_.size()}; }
  // Those that have a chance of more than `least`.
  static Range likely(const Chances& chances, float least) {
    Index first = 0;
    Index last = chances.size() - 1;
    while (first < last && chances(first) < least) ++first;
    while (last > first && chances(last) < least) --last;
    return {first, last - first + 1};
  }

  // Takes `count` samples with this sum of squares into account, at some places. Their
  // log-likelihood over that of power 1.
  double see(Chances& chances, Range at, double squares, double count) const {
    const auto half = static_cast<float>(0.5 * squares);
    const auto half_count = static_cast<float>(0.5 * count);
    const Places exponent = -half * (inverse_.segment(at.first, at.size) - 1.0F) -
                            half_count * logarithm_.segment(at.first, at.size);
    const float most = exponent.maxCoeff();
    auto here = chances.segment(at.first, at.size);
    here.array() *= (exponent - most).exp();
    const float sum = here.sum();
    here /= sum;
    return static_cast<double>(most) + std::log(static_cast<double>(sum));
  }

 private:
  static Chances normal_chances(const Eigen::ArrayXd& place, double mean, double deviation) {
    const Eigen::ArrayXd out = (-0.5 * ((place - mean) / deviation).square()).exp();
    return (out / out.sum()).cast<float>().matrix();
  }

  Places logarithm_;
  Places inverse_;
  Chances anywhere_;
  Eigen::MatrixXf moves_;  // chances of some places (rows) after each (column),
  std::vector<Index> to_;  // from this place on
};

double mean_square(const Innovations& innovations) {
  double squares = 0.0;
  double count = 0.0;
  for (const Eigen::VectorXd& white : innovations.white) {
    squares += white.squaredNorm();
    count += static_cast<double>(white.size());
  }
  return squares / count;
}

// What a level of each replicate gains over a common one, less what as many numbers would by chance
// (Schwarz 1978, Ann. Stat. 6:461).
double levels_gain(const Innovations& innovations) {
  const double all = mean_square(innovations);
  double out = 0.0;
  for (const Eigen::VectorXd& white : innovations.white) {
    const auto n = static_cast<double>(white.size());
    out -= 0.5 * n * std::log(white.squaredNorm() / n / all) + 0.5 * std::log(n);
  }
  return out + 0.5 * std::log(static_cast<double>(innovations.white.front().size()));
}

// The power hardly moves within a stretch if what is known of it is less sure than that.
Index stretch_for(double tau) {
  Index out = 1;
  while (2.0 * static_cast<double>(out) <= 0.5 * std::sqrt(tau)) out *= 2;
  return out;
}

}  // namespace

WanderingPower WanderingPower::of(const Innovations& innovations, Hertz rate, double tau) {
  return begun(innovations, rate, tau, false);
}

WanderingPower WanderingPower::from(const Innovations& innovations, Hertz rate, double tau) {
  return begun(innovations, rate, tau, true);
}

WanderingPower WanderingPower::begun(const Innovations& innovations, Hertz rate, double tau,
                                     bool any_tau) {
  constexpr int kRounds = 5;
  double longest = 0.0;
  for (const Eigen::VectorXd& white : innovations.white) {
    if (!(white.squaredNorm() > 0.0)) return {};
    longest = std::max(longest, static_cast<double>(white.size()));
  }
  const double samples = tau * rate.value;
  WanderingPower out;
  out.rate_ = rate.value;
  out.tau_ = any_tau ? std::clamp(samples, kShortestTau, longest) : samples;
  out.climb(innovations, 0, kRounds, any_tau ? longest : 0.0);
  WanderingPower alike = out;
  out.settle(any_tau);
  if (innovations.white.size() == 1) return out;
  alike.common_ = mean_square(innovations);
  alike.climb(innovations, kRounds - 3, kRounds, any_tau ? longest : 0.0);
  alike.settle(any_tau);
  alike.gain_ -= levels_gain(innovations);
  return alike.gain() > out.gain() ? alike : out;
}

double WanderingPower::level_in(const Eigen::VectorXd& white) const {
  return common_ > 0.0 ? common_ : white.squaredNorm() / static_cast<double>(white.size());
}

// Some runs of stretches that represent the whole, so many in all.
void WanderingPower::sample(const Innovations& innovations, Index wanted) {
  constexpr Index kRun = 1 << 11;  // stretches
  stretch_ = stretch_for(tau_);
  runs_.clear();
  double seen = 0.0;
  double all = 0.0;
  const auto replicates = static_cast<Index>(innovations.white.size());
  const Index most = std::max<Index>(1, wanted / kRun / replicates);  // runs of a replicate
  for (const Eigen::VectorXd& white : innovations.white) {
    const Index stretches = white.size() / stretch_;
    const bool whole = stretches <= most * kRun;
    const Index count = whole ? 1 : most;
    const Index length = whole ? stretches : kRun;
    const double mean = level_in(white);
    for (Index i = 0; i < count; ++i) {
      const Index first = i * (stretches / count);
      Eigen::ArrayXd squares(length);
      for (Index t = 0; t < length; ++t)
        squares(t) = white.segment((first + t) * stretch_, stretch_).squaredNorm() / mean;
      runs_.push_back(std::move(squares));
    }
    seen += static_cast<double>(count * length * stretch_);
    all += static_cast<double>(white.size());
  }
  share_ = seen / all;
}

double WanderingPower::objective() const {
  const WanderGrid grid(tau_, deviation_, level_, stretch_);
  const auto count = static_cast<double>(stretch_);
  std::vector<double> nats(runs_.size(), 0.0);
  for_each_index(runs_.size(), [&](std::size_t r) {
    Chances chances = grid.anywhere();
    for (Index i = 0; i < runs_[r].size(); ++i) {
      if (i > 0) grid.move(chances);
      nats[r] += grid.see(chances, grid.whole(), runs_[r](i), count);
    }
  });
  return std::accumulate(nats.begin(), nats.end(), 0.0);
}

// From one number to the next, by steps that become finer.
void WanderingPower::climb(const Innovations& innovations, int from, int rounds, double longest) {
  struct Number {
    double* value;
    double factor;
    double lowest;
    double highest;
  };
  std::vector<Number> numbers{{&deviation_, 1.6, kLeastDeviation, kMostDeviation},
                              {&level_, 1.1, 0.5, 2.0}};
  if (longest > 0.0) numbers.push_back({&tau_, 2.5, kShortestTau, longest});
  for (Number& number : numbers) number.factor = std::pow(number.factor, std::pow(0.5, from));
  for (int round = from; round < rounds; ++round) {
    constexpr Index kFew = 1 << 13;  // stretches
    constexpr Index kMany = 1 << 16;
    sample(innovations, 2 * round < rounds ? kFew : kMany);
    double best = objective();
    for (Number& number : numbers) {
      for (const double factor : {number.factor, 1.0 / number.factor}) {
        for (bool better = true; better;) {
          const double before = *number.value;
          *number.value = std::clamp(before * factor, number.lowest, number.highest);
          const double now = objective();
          better = now > best && *number.value != before;
          if (better) {
            best = now;
          } else {
            *number.value = before;
          }
        }
      }
      number.factor = std::sqrt(number.factor);
    }
  }
}

// Moves to the top of the parabola through the likelihoods around, whose curvature gives the
// standard error of the deviation. The correlation time is not known better where it is not sought.
void WanderingPower::settle(bool any_tau) {
  constexpr Index kNumbers = 3;
  const std::array<double*, kNumbers> numbers{&deviation_, &level_, &tau_};
  const std::array<double, kNumbers> steps{0.05, 0.02, 0.2};  // of their logarithms
  const std::array<double, kNumbers> before{deviation_, level_, tau_};
  using Moves = Eigen::Vector<double, kNumbers>;
  const auto nats_at = [&](const Moves& moves) {
    for (std::size_t i = 0; i < numbers.size(); ++i)
      *numbers[i] = before[i] * std::exp(steps[i] * moves(static_cast<Index>(i)));
    return objective() / share_;
  };
  const double middle = nats_at(Moves::Zero());
  Moves above;
  Moves below;
  for (Index i = 0; i < kNumbers; ++i) {
    above(i) = nats_at(Moves::Unit(i));
    below(i) = nats_at(-Moves::Unit(i));
  }
  Eigen::Matrix<double, kNumbers, kNumbers> bend;
  for (Index i = 0; i < kNumbers; ++i) {
    bend(i, i) = 2.0 * middle - above(i) - below(i);
    for (Index j = 0; j < i; ++j) {
      const Moves both = Moves::Unit(i) + Moves::Unit(j);
      bend(i, j) = bend(j, i) =
          0.5 * (above(i) + below(i) + above(j) + below(j) - nats_at(both) - nats_at(-both)) -
          middle;
    }
  }
  Moves up = Moves::Zero();
  if (const PositiveInverse inverse = positive_inverse(bend);
      std::isfinite(inverse.log_determinant)) {
    deviation_error_ = steps[0] * std::sqrt(inverse.matrix(0, 0) / share_);
    const Moves slope = 0.5 * (above - below);
    const Index sought = any_tau ? kNumbers : kNumbers - 1;
    up.head(sought) = solve_symmetric(bend.topLeftCorner(sought, sought), slope.head(sought));
    up = up.cwiseMax(-1.0).cwiseMin(1.0);
  }
  gain_ = nats_at(up);
}

WanderingPower::Evened WanderingPower::evened(const Eigen::VectorXd& white) const {
  Evened out{Eigen::ArrayXd::Ones(white.size())};
  if (runs_.empty()) return out;
  constexpr double kRarest = 1e-280;  // chance that a double holds
  constexpr double kTiny = 1e-6;      // where the factor is that at 0
  constexpr float kNone = 1e-8F;      // chance that makes no difference
  const WanderGrid grid(tau_, deviation_, level_, stretch_);
  const Eigen::ArrayXd narrower = grid.inverse().cast<double>().sqrt();
  const double level = std::sqrt(level_in(white));
  const double median = std::sqrt(level_) * std::exp(-0.25 * deviation_ * deviation_);
  Chances chances = grid.anywhere();
  WanderGrid::Range likely = grid.whole();
  for (Index t = 0; t < white.size(); ++t) {
    if (t % stretch_ == 0) {
      if (t > 0) grid.move(chances);
      likely = WanderGrid::likely(chances, kNone);
    }
    const double size = std::abs(white(t)) / level;
    double rarer = 0.0;
    double at_zero = 0.0;
    for (Index j = likely.first; j < likely.first + likely.size; ++j) {
      const auto chance = static_cast<double>(chances(j));
      if (size < kTiny) {
        at_zero += chance * narrower(j);
      } else {
        rarer += chance * normal_tail(size * narrower(j));
      }
    }
    const double narrowed =
        size < kTiny ? at_zero : -normal_quantile(std::max(rarer, kRarest)) / size;
    out.factor(t) = median * narrowed;
    out.nats += grid.see(chances, likely, size * size, 1.0);
  }
  return out;
}

}  // namespace imunoise
