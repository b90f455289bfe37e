#include "core/search/wave_scores.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <numbers>

#include "core/spectrum/cosine_transform.h"
#include "core/spectrum/fourier.h"
#include "core/support/parallel.h"

namespace imunoise {

using Index = Eigen::Index;

Index padded_length(Index n) {
  return static_cast<Index>(next_quick_length(static_cast<std::size_t>(n)));
}

double noise_level(const Current& current, std::size_t replicate, double frequency) {
  const Eigen::ArrayXd& s = current.spectrum[replicate];
  const auto place =
      static_cast<Index>(std::lround(2.0 * frequency * static_cast<double>(s.size() + 1)));
  return s(std::clamp<Index>(place - 1, 0, s.size() - 1));
}

std::complex<double> wave_sum(const Current& current, const Stretch& stretch, double frequency) {
  // Horner's rule on every eighth sample, eight sums beside each other: none waits for another.
  constexpr Index kLanes = 8;
  const double* const u = current.weighted[stretch.replicate].data() + stretch.begin;
  const double angle = -2.0 * std::numbers::pi * frequency;
  const double cosine = std::cos(static_cast<double>(kLanes) * angle);
  const double sine = std::sin(static_cast<double>(kLanes) * angle);
  std::array<double, kLanes> real{};
  std::array<double, kLanes> imag{};
  const Index rest = stretch.length % kLanes;
  std::copy(u + stretch.length - rest, u + stretch.length, real.begin());
  for (Index t = stretch.length - rest - kLanes; t >= 0; t -= kLanes) {
    for (std::size_t i = 0; i < real.size(); ++i) {
      const double turned = real[i] * cosine - imag[i] * sine;
      imag[i] = real[i] * sine + imag[i] * cosine;
      real[i] = turned + u[t + static_cast<Index>(i)];
    }
  }
  const std::complex<double> turn = std::polar(1.0, angle);
  std::complex<double> sum = 0.0;
  for (std::size_t i = real.size(); i > 0; --i)
    sum = sum * turn + std::complex<double>(real[i - 1], imag[i - 1]);
  return sum;
}

double wave_gain(const Current& current, const Stretch& stretch, double frequency) {
  return std::norm(wave_sum(current, stretch, frequency)) *
         noise_level(current, stretch.replicate, frequency) / static_cast<double>(stretch.length);
}

Eigen::ArrayXd wave_gains(const Current& current, const Stretch& stretch, Index padded) {
  std::vector<double> series(static_cast<std::size_t>(padded), 0.0);
  const double* const first = current.weighted[stretch.replicate].data() + stretch.begin;
  std::copy(first, first + stretch.length, series.begin());
  const std::vector<std::complex<double>> spectrum = half_spectrum(std::move(series));
  Eigen::ArrayXd out(static_cast<Index>(spectrum.size()));
  for (Index i = 0; i < out.size(); ++i) {
    const double f = static_cast<double>(i) / static_cast<double>(padded);
    out(i) = std::norm(spectrum[static_cast<std::size_t>(i)]) *
             noise_level(current, stretch.replicate, f) / static_cast<double>(stretch.length);
  }
  return out;
}

AllWaves all_wave_gains(const Current& current, Index padded) {
  const Subject& subject = current.subject();
  std::vector<Eigen::ArrayXd> each(subject.replicates());
  const auto first_of = [&](Index samples) {
    return static_cast<Index>(
        std::ceil(kFewestPeriods * static_cast<double>(padded) / static_cast<double>(samples)));
  };
  for_each_index(each.size(), [&](std::size_t k) {
    each[k] = wave_gains(current, {k, 0, subject.length(k)}, padded);
    each[k].head(std::min(first_of(subject.length(k)), each[k].size())).setZero();
  });
  AllWaves out{.first = first_of(subject.length(current.longest()))};
  const Index count = each[0].size() - 1 - out.first;
  if (count < 2) return out;
  out.gain = each[0].segment(out.first, count);
  for (std::size_t k = 1; k < each.size(); ++k) out.gain += each[k].segment(out.first, count);
  return out;
}

}  // namespace imunoise
