#include "tests/hidden_effects/generator/borrowed_scene.h"

#include <bit>

#include "tests/hidden_effects/generator/cosine.h"

namespace imunoise::hidden {
namespace {

Series banded_spectrum(const std::vector<Series>& measured) {
  const std::size_t n = measured.front().size();
  Series power(n - 1, 0.0);
  for (const Series& x : measured) {
    const Series coefficients = cosine_coefficients(x);
    for (std::size_t k = 1; k < n; ++k) {
      power[k - 1] += coefficients[k] * coefficients[k] / static_cast<double>(measured.size());
    }
  }
  for (std::size_t begin = 0; begin < n - 1;) {
    const std::size_t end = std::min(n - 1, begin + 1 + begin / 14);
    double mean = 0.0;
    for (std::size_t k = begin; k < end; ++k) mean += power[k] / static_cast<double>(end - begin);
    std::fill(power.begin() + static_cast<std::ptrdiff_t>(begin),
              power.begin() + static_cast<std::ptrdiff_t>(end), mean);
    begin = end;
  }
  return power;
}

}  // namespace

Scene borrow_scene(std::vector<Series> measured, double rate_hz, RandomStream random) {
  std::size_t samples = measured.front().size();
  for (const Series& x : measured) samples = std::min(samples, x.size());
  samples = std::bit_floor(samples);
  Scene out;
  out.rate_hz = rate_hz;
  for (Series& x : measured) x.resize(samples);
  out.spectrum = banded_spectrum(measured);
  for (Series& x : measured) {
    Recording& recording = out.recordings.emplace_back();
    recording.traces.push_back({std::string(kSubject), "rad/s", std::move(x)});
    out.surroundings.push_back(draw_surroundings(Weather::kLively, samples, rate_hz, random));
    add_witnesses(out.surroundings.back(), random, recording);
  }
  out.random = random;
  return out;
}

}  // namespace imunoise::hidden
