#include "core/search/wave_scores.h"

#include <algorithm>
#include <cmath>
#include <numbers>

#include "core/spectrum/cosine_transform.h"
#include "core/spectrum/fourier.h"

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
  const Eigen::VectorXd& u = current.weighted[stretch.replicate];
  const std::complex<double> turn = std::polar(1.0, -2.0 * std::numbers::pi * frequency);
  std::complex<double> sum = 0.0;
  for (Index t = stretch.length - 1; t >= 0; --t) sum = sum * turn + u(stretch.begin + t);
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

}  // namespace imunoise
