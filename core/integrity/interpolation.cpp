#include "core/integrity/interpolation.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <complex>
#include <numbers>
#include <vector>

#include "core/spectrum/cosine_transform.h"
#include "core/spectrum/fourier.h"

namespace imunoise {
namespace {

using Complex = std::complex<double>;

constexpr std::size_t kFewest = 1024;
constexpr std::size_t kBins = 24;  // of a period

// Squares of first or second differences; what is far beyond the usual counts as that.
std::vector<double> squares_of(std::span<const double> x, bool second) {
  constexpr double kFarBeyond = 30.0;  // times the median, which is 0.45 of the mean of squares
  std::vector<double> out(x.size() - 2);
  for (std::size_t i = 0; i < out.size(); ++i) {
    const double step = x[i + 1] - x[i];
    const double change = second ? x[i + 2] - x[i + 1] - step : step;
    out[i] = change * change;
  }
  std::vector<double> sorted = out;
  const auto middle = sorted.begin() + static_cast<std::ptrdiff_t>(sorted.size() / 2);
  std::nth_element(sorted.begin(), middle, sorted.end());
  double mean = 0.0;
  for (double& one : out) {
    one = std::min(one, kFarBeyond * *middle);
    mean += one / static_cast<double>(out.size());
  }
  if (!(mean > 0.0)) return {};
  for (double& one : out) one = one / mean - 1.0;
  return out;
}

Complex turned_sum(const std::vector<double>& s, double frequency) {
  Complex sum = 0.0;
  const Complex step = std::polar(1.0, -2.0 * std::numbers::pi * frequency);
  constexpr std::size_t kFresh = 1024;  // products, before rounding counts
  Complex turn = 1.0;
  for (std::size_t i = 0; i < s.size(); ++i) {
    if (i % kFresh == 0)
      turn = std::polar(
          1.0, -2.0 * std::numbers::pi * std::remainder(frequency * static_cast<double>(i), 1.0));
    sum += s[i] * turn;
    turn *= step;
  }
  return sum;
}

struct Beat {
  double frequency = 0.0;  // cycles per sample; 0: none
  Complex amplitude = 0.0;
};

// Mean power of the frequencies on both sides of one, its neighbours left out: noise that rings
// beats with itself over a band.
double mean_beside(const std::vector<Complex>& all, std::size_t place) {
  constexpr std::size_t kNear = 3;
  constexpr std::size_t kFar = 40;
  double sum = 0.0;
  double count = 0.0;
  for (std::size_t off = kNear; off <= kFar; ++off) {
    for (const std::size_t k : {place - off, place + off}) {
      if (k == 0 || k >= all.size()) continue;  // below 0 it wraps
      sum += std::norm(all[k]);
      count += 1.0;
    }
  }
  return count > 0.0 ? sum / count : 0.0;
}

// The strongest wave of a series of mean 0, its frequency between those of the transform.
Beat strongest_beat(const std::vector<double>& s) {
  constexpr double kBeyondChance = 25.0;  // of the mean power: once in 1e11 frequencies
  const std::vector<Complex> all = half_spectrum(s);
  std::size_t best = 1;
  double sum = 0.0;
  for (std::size_t k = 1; k < all.size(); ++k) {
    sum += std::norm(all[k]);
    if (std::norm(all[k]) > std::norm(all[best])) best = k;
  }
  if (std::norm(all[best]) * static_cast<double>(all.size()) < kBeyondChance * sum) return {};
  if (std::norm(all[best]) < kBeyondChance * mean_beside(all, best)) return {};
  const auto n = static_cast<double>(s.size());
  double low = (static_cast<double>(best) - 1.0) / n;
  double high = std::min(0.5, (static_cast<double>(best) + 1.0) / n);
  constexpr int kSteps = 30;
  for (int i = 0; i < kSteps; ++i) {
    const double left = low + 0.382 * (high - low);
    const double right = high - 0.382 * (high - low);
    const bool lower = std::norm(turned_sum(s, left)) > std::norm(turned_sum(s, right));
    (lower ? high : low) = lower ? right : left;
  }
  const double at = 0.5 * (low + high);
  return {at, turned_sum(s, at) / n};
}

// Mean square of the first or second difference of white noise, interpolated `ratio` original
// samples apart, its middle at `place` between two of them. The same at -place.
double expected_square(double ratio, double place, bool second) {
  const auto weight = [](double off) { return std::max(0.0, 1.0 - std::abs(off)); };
  const auto reach = static_cast<int>(std::ceil(ratio)) + 1;
  double sum = 0.0;
  for (int m = -reach; m <= reach + 1; ++m) {
    const double at = place - m;
    const double w = second ? weight(at - ratio) - 2.0 * weight(at) + weight(at + ratio)
                            : weight(at + 0.5 * ratio) - weight(at - 0.5 * ratio);
    sum += w * w;
  }
  return sum;
}

// A part of a beat; phase 0 is where the wave is highest.
struct Bin {
  double phase = 0.0;  // mean of its samples, in periods
  double mean = 0.0;   // of the squares, relative to that of all
  double count = 0.0;
};

std::vector<Bin> folded(const std::vector<double>& s, double frequency) {
  const double phase = std::arg(turned_sum(s, frequency)) / (2.0 * std::numbers::pi);
  std::vector<Bin> out(kBins);
  for (std::size_t i = 0; i < s.size(); ++i) {
    double at = frequency * static_cast<double>(i) + phase;
    at -= std::floor(at);
    const auto bin = static_cast<std::size_t>(at * static_cast<double>(kBins));
    Bin& to = out[std::min(bin, kBins - 1)];
    to.phase += at;
    to.mean += s[i];
    to.count += 1.0;
  }
  std::erase_if(out, [](const Bin& one) { return one.count == 0.0; });
  for (Bin& one : out) {
    one.phase /= one.count;
    one.mean = 1.0 + one.mean / one.count;
  }
  return out;
}

// Root mean square difference of what is measured and expected, relative to how uneven the latter
// is; infinite where it is even.
double difference(const std::vector<Bin>& measured, double ratio, bool second) {
  const bool low_between =
      expected_square(ratio, 0.0, second) > expected_square(ratio, 0.5, second);
  const double middle = low_between ? 0.0 : 0.5;
  double sum = 0.0;
  double count = 0.0;
  for (const Bin& one : measured) {
    sum += one.count * expected_square(ratio, one.phase + middle, second);
    count += one.count;
  }
  double off = 0.0;
  double uneven = 0.0;
  for (const Bin& one : measured) {
    const double expected = expected_square(ratio, one.phase + middle, second) * count / sum;
    off += one.count * (one.mean - expected) * (one.mean - expected);
    uneven += one.count * (expected - 1.0) * (expected - 1.0);
  }
  // What chance does to squares of normal numbers, in as many bins.
  const double chance = 2.0 * static_cast<double>(measured.size());
  return std::sqrt(std::max(0.0, off - chance) / uneven);
}

}  // namespace

double interpolation_beat(std::span<const double> x) {
  constexpr double kLeastBeat = 0.1;  // of the mean power
  constexpr double kAlike = 0.15;
  constexpr double kMostRatio = 4.0;
  // A beat at half of the rate has no phase to fold by: there, samples lie on straight lines.
  constexpr double kHalf = 0.499;
  if (x.size() < kFewest) return 0.0;
  const std::span<const double> some =
      x.first(quick_length(std::min(x.size(), kMostInterpolated) - 2) + 2);
  const std::vector<double> bends = squares_of(some, true);
  if (bends.empty()) return 0.0;
  const Beat beat = strongest_beat(bends);
  if (!(std::abs(beat.amplitude) > 0.5 * kLeastBeat) || beat.frequency > kHalf) return 0.0;
  const std::vector<Bin> of_bends = folded(bends, beat.frequency);
  const std::vector<Bin> of_steps = folded(squares_of(some, false), beat.frequency);
  for (double whole = 0.0; whole <= kMostRatio; whole += 1.0) {
    for (const double ratio : {whole - beat.frequency, whole + beat.frequency}) {
      if (!(ratio > 0.1) || ratio > kMostRatio) continue;
      if (difference(of_bends, ratio, true) < kAlike && difference(of_steps, ratio, false) < kAlike)
        return beat.frequency;
    }
  }
  return 0.0;
}

}  // namespace imunoise
