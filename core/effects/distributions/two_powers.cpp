#include "core/effects/distributions/two_powers.h"

#include <algorithm>
#include <cmath>

#include "core/support/distributions.h"
#include "core/support/parallel.h"

namespace imunoise {
namespace {

using Index = Eigen::Index;

constexpr Index kBurstStretch = 16;  // samples
constexpr Index kFineStretch = 4;
constexpr int kSteps = 40;  // of a climb
constexpr int kFineSteps = 10;

// Logarithm of the density of a stretch's mean power, but for what the variance does not change.
struct PowerDensity {
  double level;      // of power 0
  double per_power;  // its slope

  PowerDensity(double variance, double samples)
      : level(-0.5 * samples * std::log(variance)), per_power(-0.5 * samples / variance) {}
  double operator()(double power) const { return level + per_power * power; }
};

}  // namespace

TwoPowers TwoPowers::of(const Innovations& innovations, Hertz rate,
                        const std::optional<BurstTimes>& times) {
  TwoPowers start;
  start.rate_ = rate.value;
  if (!start.cut(innovations, kBurstStretch, Levels::kOwn)) return {};
  const auto begun = [&](double stretches_loud, double stretches_every) {
    TwoPowers out = start;
    out.variance_[0] = 0.7;
    out.variance_[1] = 4.0;
    out.change_[1] = std::min(0.9, 1.0 / stretches_loud);
    out.change_[0] = std::min(0.9, 1.0 / std::max(1.0, stretches_every - stretches_loud));
    out.climb(!times, kSteps);
    return out;
  };
  TwoPowers out = start;
  if (times) {
    const double each = 1.0 / start.stretch_s();
    out = begun(times->length_s * each, times->every_s * each);
  } else {
    TwoPowers brief = begun(3.0, 60.0);
    TwoPowers lasting = begun(40.0, 400.0);
    out = brief.gain() > lasting.gain() ? std::move(brief) : std::move(lasting);
  }
  out.sharpen(innovations, !times);
  return out.gain() > 0.0 ? out.of_one_level(innovations, !times) : out;
}

// Into stretches of so many samples. False: a replicate is too short or silent.
bool TwoPowers::cut(const Innovations& innovations, Index stretch, Levels levels) {
  stretch_ = stretch;
  replicates_.clear();
  double sum = 0.0;
  double count = 0.0;
  for (const Eigen::VectorXd& white : innovations.white) {
    Eigen::ArrayXd power(white.size() / stretch);
    for (Index i = 0; i < power.size(); ++i)
      power(i) = white.segment(i * stretch, stretch).squaredNorm() / static_cast<double>(stretch);
    const double mean = power.size() > 0 ? power.mean() : 0.0;
    if (!(mean > 0.0)) return false;
    sum += power.sum();
    count += static_cast<double>(power.size());
    replicates_.push_back({std::move(power), mean, 1.0, {}});
  }
  for (Replicate& one : replicates_) {
    const double mean = one.unit;
    if (levels == Levels::kCommon) one.unit = sum / count;
    one.power /= one.unit;
    one.level = mean / one.unit;
  }
  return true;
}

// Replicates with more bursts than others have a higher mean, though both powers are the same.
// Their own levels must be worth their number (Schwarz 1978).
TwoPowers TwoPowers::of_one_level(const Innovations& innovations, bool times) const {
  TwoPowers out = *this;
  if (replicates_.size() < 2 || !out.cut(innovations, stretch_, Levels::kCommon)) return *this;
  out.climb(times, kFineSteps);
  double samples = 0.0;
  for (const Eigen::VectorXd& white : innovations.white)
    samples += static_cast<double>(white.size());
  const double price = 0.5 * static_cast<double>(replicates_.size() - 1) * std::log(samples);
  return out.gain() > gain() - price ? out : *this;
}

// Bursts end within a stretch. Where they last for few of them, that makes the powers too alike.
void TwoPowers::sharpen(const Innovations& innovations, bool times) {
  constexpr double kFew = 64.0;  // stretches
  if (!(gain() > 0.0) || change_[1] * kFew < 1.0) return;
  const double finer = static_cast<double>(kFineStretch) / static_cast<double>(stretch_);
  if (!cut(innovations, kFineStretch, Levels::kOwn)) return;
  for (double& one : change_) one *= finer;
  climb(times, kFineSteps);
}

double TwoPowers::stretch_s() const { return static_cast<double>(stretch_) / rate_; }

void TwoPowers::climb(bool times, int steps) {
  constexpr double kSettledNats = 0.01;
  double before = -INFINITY;
  for (int step = 0; step < steps; ++step) {
    for_each_index(replicates_.size(), [&](std::size_t k) { expect(replicates_[k]); });
    if (likelihood() - before < kSettledNats) return;
    before = likelihood();
    if (step + 1 < steps) maximise(times);
  }
}

// Forward and backward, each stretch scaled to a sum of 1.
void TwoPowers::expect(Replicate& one) const {
  const Index n = one.power.size();
  const double loud_share = change_[0] / (change_[0] + change_[1]);
  const auto samples = static_cast<double>(stretch_);
  const PowerDensity of_quiet(variance_[0], samples);
  const PowerDensity of_loud(variance_[1], samples);
  const PowerDensity of_constant(one.level, samples);
  Eigen::ArrayXXd forward(n, 2);
  Eigen::ArrayXXd density(n, 2);
  Eigen::ArrayXd scale(n);
  one.likelihood = 0.0;
  one.gain = 0.0;
  double before[2] = {1.0 - loud_share, loud_share};
  for (Index i = 0; i < n; ++i) {
    const double quiet = of_quiet(one.power(i));
    const double loud = of_loud(one.power(i));
    const double top = std::max(quiet, loud);
    const double less = std::exp(-std::abs(quiet - loud));
    density(i, 0) = quiet < loud ? less : 1.0;
    density(i, 1) = quiet < loud ? 1.0 : less;
    const double reached[2] = {
        i == 0 ? before[0] : before[0] * (1.0 - change_[0]) + before[1] * change_[1],
        i == 0 ? before[1] : before[0] * change_[0] + before[1] * (1.0 - change_[1])};
    forward(i, 0) = reached[0] * density(i, 0);
    forward(i, 1) = reached[1] * density(i, 1);
    scale(i) = forward(i, 0) + forward(i, 1);
    forward.row(i) /= scale(i);
    before[0] = forward(i, 0);
    before[1] = forward(i, 1);
    const double here = top + std::log(scale(i));
    one.likelihood += here;
    one.gain += here - of_constant(one.power(i));
  }
  one.loud.resize(n);
  one.starts = 0.0;
  one.ends = 0.0;
  double back[2] = {1.0, 1.0};
  for (Index i = n; i-- > 0;) {
    one.loud(i) = forward(i, 1) * back[1] / (forward(i, 0) * back[0] + forward(i, 1) * back[1]);
    if (i == 0) break;
    const double quiet = density(i, 0) * back[0] / scale(i);
    const double loud = density(i, 1) * back[1] / scale(i);
    one.starts += forward(i - 1, 0) * change_[0] * loud;
    one.ends += forward(i - 1, 1) * change_[1] * quiet;
    back[0] = (1.0 - change_[0]) * quiet + change_[0] * loud;
    back[1] = change_[1] * quiet + (1.0 - change_[1]) * loud;
  }
}

void TwoPowers::maximise(bool times) {
  double loud = 0.0;
  double loud_power = 0.0;
  double all = 0.0;
  double power = 0.0;
  double starts = 0.0;
  double ends = 0.0;
  for (const Replicate& one : replicates_) {
    loud += one.loud.sum();
    loud_power += (one.loud * one.power).sum();
    all += static_cast<double>(one.power.size());
    power += one.power.sum();
    starts += one.starts;
    ends += one.ends;
  }
  constexpr double kFewest = 1e-6;  // stretches
  if (!(loud > kFewest) || !(all - loud > kFewest)) return;
  variance_[1] = loud_power / loud;
  variance_[0] = (power - loud_power) / (all - loud);
  if (!times) return;
  constexpr double kLeastChange = 1e-7;
  change_[0] = std::clamp(starts / (all - loud), kLeastChange, 0.5);
  change_[1] = std::clamp(ends / loud, kLeastChange, 0.5);
}

double TwoPowers::likelihood() const {
  double out = 0.0;
  for (const Replicate& one : replicates_) out += one.likelihood;
  return out;
}

double TwoPowers::gain() const {
  double out = 0.0;
  for (const Replicate& one : replicates_) out += one.gain;
  return out;
}

BurstTimes TwoPowers::times() const {
  const double each = stretch_s();
  return {each / change_[1], each / change_[1] + each / change_[0]};
}

double TwoPowers::kurtosis_ratio() const {
  const double loud = change_[0] / (change_[0] + change_[1]);
  const double mean = (1.0 - loud) * variance_[0] + loud * variance_[1];
  const double square =
      (1.0 - loud) * variance_[0] * variance_[0] + loud * variance_[1] * variance_[1];
  return square / (mean * mean);
}

double TwoPowers::gain_in(std::size_t replicate) const {
  return replicates_.empty() ? 0.0 : replicates_[replicate].gain;
}

Eigen::ArrayXd TwoPowers::factor(std::size_t replicate, const Eigen::VectorXd& white) const {
  Eigen::ArrayXd out = Eigen::ArrayXd::Ones(white.size());
  if (replicates_.empty()) return out;
  constexpr double kRarest = 1e-280;  // chance that a double holds
  const double quiet = std::sqrt(variance_[0] * replicates_[replicate].unit);
  const double ratio_of_deviations = std::sqrt(ratio());
  const double per_square = 0.5 * (1.0 - 1.0 / ratio());
  const double per_sample = 0.5 * std::log(ratio());
  double loud = change_[0] / (change_[0] + change_[1]);  // chance, given all before
  for (Index begin = 0; begin < white.size(); begin += stretch_) {
    if (begin > 0) loud = (1.0 - loud) * change_[0] + loud * (1.0 - change_[1]);
    double log_odds = std::log(loud / (1.0 - loud));
    const Index end = std::min(begin + stretch_, white.size());
    for (Index t = begin; t < end; ++t) {
      const double size = std::abs(white(t)) / quiet;
      const double rarer =
          (1.0 - loud) * normal_tail(size) + loud * normal_tail(size / ratio_of_deviations);
      constexpr double kTiny = 1e-6;  // where the factor is that at 0
      out(t) = size < kTiny ? 1.0 - loud + loud / ratio_of_deviations
                            : -normal_quantile(std::max(rarer, kRarest)) / size;
      log_odds += per_square * size * size - per_sample;
      loud = 1.0 / (1.0 + std::exp(-log_odds));
    }
  }
  return out;
}

}  // namespace imunoise
