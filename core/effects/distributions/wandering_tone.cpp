#include "core/effects/distributions/wandering_tone.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <numbers>

#include "core/support/distributions.h"
#include "core/support/parallel.h"
#include "core/support/roots.h"

namespace imunoise {
namespace {

using Index = Eigen::Index;
using Occupancy = WanderingTone::Occupancy;

constexpr Index kPlaces = WanderingTone::kPlaces;
constexpr double kTurn = 2.0 * std::numbers::pi;
constexpr float kOftenest = 0.25F;  // moves each way, a sample

// No frequency is impossible.
Occupancy possible(const Occupancy& occupancy) {
  constexpr double kRarest = 1e-3;
  const Occupancy out = occupancy + kRarest * occupancy.sum() / static_cast<double>(kPlaces);
  return out / out.sum();
}

}  // namespace

// Diffusion below what the grid of phases can show is taken as that.
ToneFilter::ToneFilter(const WanderingTone& tone, const Occupancy& occupancy)
    : turns_(static_cast<std::size_t>(kPlaces)), occupancy_(possible(occupancy)) {
  constexpr double kPlace = kTurn / static_cast<double>(kPhases);
  const double deviation = std::sqrt(std::max(tone.diffusion, 0.3 * kPlace * kPlace)) / kPlace;
  const auto reach = std::clamp<Index>(std::lround(std::ceil(3.2 * deviation)), 2, kPhases / 4);
  for (Index g = 0; g < kPhases; ++g)
    tone_(g) = static_cast<float>(tone.amplitude * std::cos(kPlace * static_cast<double>(g)));
  for (Index j = 0; j < kPlaces; ++j) {
    const double turn = tone.frequency(j) * static_cast<double>(kPhases);
    Turn& out = turns_[static_cast<std::size_t>(j)];
    out.whole = std::lround(turn);
    double sum = 0.0;
    std::vector<double> weights;
    for (Index k = -reach; k <= reach; ++k) {
      const double away = (static_cast<double>(out.whole + k) - turn) / deviation;
      weights.push_back(std::exp(-0.5 * away * away));
      sum += weights.back();
    }
    for (const double one : weights) out.weights.push_back(static_cast<float>(one / sum));
    // Moves that keep the occupancy: as many up as down.
    const auto chance = [&](Index to) {
      if (to < 0 || to >= kPlaces) return 0.0F;
      return std::min(kOftenest,
                      static_cast<float>(tone.pace * std::sqrt(occupancy_(to) / occupancy_(j))));
    };
    up_(j) = chance(j + 1);
    down_(j) = chance(j - 1);
  }
}

// To the next sample.
void ToneFilter::move(const Chances& before, Chances& after) const {
  constexpr float kNone = 1e-7F;  // chances that make no difference
  const Eigen::Array<float, 1, kPlaces> mass = before.colwise().sum();
  // Three turns side by side: no index leaves them.
  std::array<float, 3 * kPhases> unrolled;
  for (Index j = 0; j < kPlaces; ++j) {
    const float near = mass(j) + (j > 0 ? up_(j - 1) * mass(j - 1) : 0.0F) +
                       (j + 1 < kPlaces ? down_(j + 1) * mass(j + 1) : 0.0F);
    if (near < kNone) {
      after.col(j).setZero();
      continue;
    }
    Phases here = (1.0F - up_(j) - down_(j)) * before.col(j);
    if (j > 0) here += up_(j - 1) * before.col(j - 1);
    if (j + 1 < kPlaces) here += down_(j + 1) * before.col(j + 1);
    for (Index turn = 0; turn < 3; ++turn)
      Eigen::Map<Phases>(unrolled.data() + turn * kPhases) = here;
    const Turn& by = turns_[static_cast<std::size_t>(j)];
    const auto reach = static_cast<Index>(by.weights.size() / 2);
    const float* from = unrolled.data() + kPhases - by.whole + reach;
    Phases sum = Phases::Zero();
    for (const float weight : by.weights) sum += weight * Eigen::Map<const Phases>(from--);
    after.col(j) = sum;
  }
}

double ToneFilter::normal_number(double sample, const Phases& chances) const {
  constexpr double kLeast = 1e-300;
  double below = 0.0;
  double above = 0.0;
  // The tone at a phase and at the opposite one is the same.
  for (Index g = 0; g <= kPhases / 2; ++g) {
    const bool single = g == 0 || g == kPhases / 2;
    const double chance = chances(g) + (single ? 0.0F : chances(kPhases - g));
    const double away = (sample - static_cast<double>(tone_(g))) / std::numbers::sqrt2;
    // The smaller tail has all its digits.
    const double tail = 0.5 * std::erfc(std::abs(away));
    below += chance * (away < 0.0 ? tail : 1.0 - tail);
    above += chance * (away < 0.0 ? 1.0 - tail : tail);
  }
  const double tail = std::max(kLeast, std::min(below, above) / (below + above));
  return below < above ? normal_quantile(tail) : -normal_quantile(tail);
}

template <bool kNormal>
ToneFilter::Passed ToneFilter::filter(const Eigen::Ref<const Eigen::VectorXd>& samples,
                                      Eigen::VectorXd* normal) const {
  constexpr Index kSummed = 1024;  // samples, as floats
  Passed out{.nats = 0.0, .occupancy = Occupancy::Zero()};
  Chances now;
  for (Index j = 0; j < kPlaces; ++j)
    now.col(j).setConstant(static_cast<float>(occupancy_(j) / static_cast<double>(kPhases)));
  Chances seen;
  Chances sum = Chances::Zero();
  const Phases half_square = 0.5F * tone_.square();
  for (Index t = 0; t < samples.size(); ++t) {
    Phases chances = now.col(0);
    for (Index j = 1; j < kPlaces; ++j) chances += now.col(j);
    // Likelihood of the sample at each phase, over that without a tone.
    Phases likely = static_cast<float>(samples(t)) * tone_ - half_square;
    const float most = likely.maxCoeff();
    likely = (likely - most).exp();
    const float all = (chances * likely).sum();
    if constexpr (kNormal) (*normal)(t) = normal_number(samples(t), chances);
    out.nats += static_cast<double>(most) + std::log(static_cast<double>(all / chances.sum()));
    likely /= all;
    for (Index j = 0; j < kPlaces; ++j) seen.col(j) = now.col(j) * likely;
    sum += seen;
    if (t % kSummed == kSummed - 1 || t + 1 == samples.size()) {
      out.occupancy += sum.colwise().sum().transpose().cast<double>();
      sum.setZero();
    }
    move(seen, now);
  }
  out.occupancy /= static_cast<double>(samples.size());
  return out;
}

ToneFilter::Passed ToneFilter::pass(const Eigen::Ref<const Eigen::VectorXd>& samples) const {
  return filter<false>(samples, nullptr);
}

ToneFilter::Passed ToneFilter::pass(const Eigen::Ref<const Eigen::VectorXd>& samples,
                                    Eigen::VectorXd& normal) const {
  normal.resize(samples.size());
  return filter<true>(samples, &normal);
}

namespace {

// Stretches of all series that stand for the whole, about `samples` in all.
class Stretches {
 public:
  Stretches(const std::vector<ToneSeries>& series, Index samples) : series_(series) {
    constexpr Index kLength = 1024;
    const Index each = std::max<Index>(1, samples / kLength / static_cast<Index>(series.size()));
    for (std::size_t k = 0; k < series.size(); ++k) {
      const Index n = series[k].samples.size();
      const Index length = std::min(n, kLength);
      const Index count = std::min(each, n / length);
      for (Index i = 0; i < count; ++i) of_.push_back({k, i * (n / count), length});
      samples_ += static_cast<double>(count * length);
      whole_ += static_cast<double>(n);
    }
  }
  double share() const { return samples_ / whole_; }

  /// Log-likelihood, and the mean occupancy of each series.
  struct Passed {
    double nats = 0.0;
    std::vector<Occupancy> occupancy{};
  };
  Passed pass(const FittedTone& tone) const {
    std::vector<ToneFilter::Passed> passed(of_.size());
    for_each_index(of_.size(), [&](std::size_t i) {
      const Stretch& at = of_[i];
      const ToneSeries& in = series_[at.series];
      passed[i] = tone.filter(in, at.series).pass(in.samples.segment(at.first, at.length));
    });
    Passed out{.occupancy = std::vector<Occupancy>(series_.size(), Occupancy::Zero())};
    for (std::size_t i = 0; i < of_.size(); ++i) {
      out.nats += passed[i].nats;
      out.occupancy[of_[i].series] += passed[i].occupancy;
    }
    for (Occupancy& one : out.occupancy) one /= one.sum();
    return out;
  }

 private:
  struct Stretch {
    std::size_t series;
    Index first;
    Index length;
  };
  const std::vector<ToneSeries>& series_;
  std::vector<Stretch> of_;
  double samples_ = 0.0;
  double whole_ = 0.0;
};

std::vector<Occupancy> anywhere(std::size_t series) {
  return std::vector<Occupancy>(series, Occupancy::Constant(1.0 / static_cast<double>(kPlaces)));
}

// Amplitude that the power tells.
double amplitude_of(const std::vector<ToneSeries>& series) {
  constexpr double kWeakest = 0.05;  // over the noise
  double squares = 0.0;
  double least = 0.0;
  double samples = 0.0;
  for (const ToneSeries& one : series) {
    const double unit = one.unit * one.unit;
    const auto n = static_cast<double>(one.samples.size());
    squares += 2.0 * unit * (one.samples.squaredNorm() - n);
    least += kWeakest * kWeakest * unit * n;
    samples += n;
  }
  return std::sqrt(std::max(least, squares) / samples);
}

// Moves the amplitude to the top of the parabola through the likelihoods beside it. Their curvature
// gives its standard error; and a grid is no tone: simulated amplitudes came out up to 2 % large.
void settle_amplitude(FittedTone& fitted, const Stretches& stretches) {
  const double amplitude = fitted.tone.amplitude;
  const double step = 0.03 * amplitude;
  const auto nats_at = [&](double moved) {
    fitted.tone.amplitude = amplitude + moved;
    return stretches.pass(fitted).nats;
  };
  const double here = nats_at(0.0);
  const double above = nats_at(step);
  const double below = nats_at(-step);
  const double bend = 2.0 * here - above - below;
  fitted.tone.amplitude = amplitude;
  if (!(bend > 0.0)) return;
  fitted.tone.amplitude += step * std::clamp(0.5 * (above - below) / bend, -1.0, 1.0);
  constexpr double kGrid = 0.01;
  fitted.amplitude_error =
      std::hypot(kGrid * amplitude, step * std::sqrt(stretches.share() / bend));
}

// Amplitude at which the likelihood of all samples lies 1.92 nats below that of no tone; of a tone
// that may be anywhere in the band.
double highest_of(const FittedTone& fitted, const Stretches& stretches) {
  const double below = 0.5 * chi_square_quantile(0.95, 1.0) * stretches.share();
  FittedTone other{.tone = {.from = fitted.tone.from, .to = fitted.tone.to},
                   .occupancy = anywhere(fitted.occupancy.size())};
  const auto excess = [&](double amplitude) {
    other.tone.amplitude = amplitude;
    return stretches.pass(other).nats + below;
  };
  double high = fitted.tone.amplitude;
  while (excess(high) > 0.0) high *= 2.0;
  return root_between(excess, 0.0, high);
}

}  // namespace

ToneFilter FittedTone::filter(const ToneSeries& series, std::size_t number) const {
  WanderingTone own = tone;
  own.amplitude /= series.unit;
  return {own, occupancy[number]};
}

FittedTone fit_tone(double from, double to, const std::vector<ToneSeries>& series) {
  constexpr int kRounds = 4;
  const Stretches some(series, 1 << 16);
  const Stretches more(series, 1 << 17);
  FittedTone out{.tone = {.from = from, .to = to, .amplitude = amplitude_of(series)},
                 .occupancy = anywhere(series.size())};
  for (int i = 0; i < 3; ++i) out.occupancy = more.pass(out).occupancy;
  struct Number {
    double* value;
    double factor;
    double highest;
  };
  std::array<Number, 3> numbers{Number{&out.tone.amplitude, 1.15, INFINITY},
                                Number{&out.tone.diffusion, 2.0, 0.2},
                                Number{&out.tone.pace, 2.5, 0.25}};
  double best = 0.0;
  for (int round = 0; round < kRounds; ++round) {
    best = some.pass(out).nats;
    for (Number& number : numbers) {
      for (const double factor : {number.factor, 1.0 / number.factor}) {
        for (bool better = true; better;) {
          const double before = *number.value;
          *number.value = std::min(number.highest, before * factor);
          const double now = some.pass(out).nats;
          better = now > best;
          if (better) {
            best = now;
          } else {
            *number.value = before;
          }
        }
      }
      number.factor = std::sqrt(number.factor);
    }
    out.occupancy = more.pass(out).occupancy;
  }
  constexpr double kOnceIn20 = 0.95;
  const auto replicates = static_cast<double>(series.size());
  const double numbers_found = 3.0 + static_cast<double>(kPlaces - 1) * replicates;
  const double nats = more.pass(out).nats;
  out.nats = nats / more.share();
  out.seen = nats > 0.5 * chi_square_quantile(kOnceIn20, numbers_found);
  if (out.seen) {
    settle_amplitude(out, more);
  } else {
    out.highest = highest_of(out, some);
  }
  return out;
}

}  // namespace imunoise
