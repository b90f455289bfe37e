#include "tests/hidden_effects/generator/base_noise.h"

#include <cmath>
#include <numbers>

#include "tests/hidden_effects/generator/draw.h"

namespace imunoise::hidden {
namespace {

double angle(std::size_t k, std::size_t samples) {
  return std::numbers::pi * static_cast<double>(k) / static_cast<double>(samples);
}

Series walk_spectrum(double gamma, std::size_t samples) {
  Series out(samples - 1);
  for (std::size_t k = 1; k < samples; ++k) {
    const double s = std::sin(0.5 * angle(k, samples));
    out[k - 1] = gamma * gamma / (4.0 * s * s);
  }
  return out;
}

// Variance of x over that of e: Jenkins & Watts 1968, eq. 5.2.33 with φ1 = 2r cos ω, φ2 = -r².
double ringing_gain(const Ringing& ringing) {
  const double r2 = ringing.radius * ringing.radius;
  return (1.0 + r2) / ((1.0 - r2) * (1.0 + r2 * r2 - 2.0 * r2 * std::cos(2.0 * ringing.omega)));
}

}  // namespace

void add(Series& to, const Series& part) {
  for (std::size_t i = 0; i < to.size(); ++i) to[i] += part[i];
}

Series simulate(const Markov& markov, RandomStream& random, std::size_t samples) {
  const double phi = std::exp(-1.0 / markov.tau);
  const double innovation = markov.deviation * std::sqrt(1.0 - phi * phi);
  Series out(samples);
  double state = markov.deviation * random.normal();
  for (double& x : out) {
    x = state;
    state = phi * state + innovation * random.normal();
  }
  return out;
}

Series spectrum(const Markov& markov, std::size_t samples) {
  const double phi = std::exp(-1.0 / markov.tau);
  const double power = markov.deviation * markov.deviation * (1.0 - phi * phi);
  Series out(samples - 1);
  for (std::size_t k = 1; k < samples; ++k) {
    const double s = std::sin(0.5 * angle(k, samples));
    out[k - 1] = power / ((1.0 - phi) * (1.0 - phi) + 4.0 * phi * s * s);
  }
  return out;
}

Series simulate(const Ringing& ringing, RandomStream& random, std::size_t samples) {
  const double innovation = ringing.deviation / std::sqrt(ringing_gain(ringing));
  const double first = 2.0 * ringing.radius * std::cos(ringing.omega);
  const double second = -ringing.radius * ringing.radius;
  const auto settling = static_cast<std::size_t>(40.0 / (1.0 - ringing.radius));
  Series out(samples);
  double last = 0.0;
  double before = 0.0;
  for (std::size_t t = 0; t < samples + settling; ++t) {
    const double x = first * last + second * before + innovation * random.normal();
    before = last;
    last = x;
    if (t >= settling) out[t - settling] = x;
  }
  return out;
}

Series spectrum(const Ringing& ringing, std::size_t samples) {
  const double power = ringing.deviation * ringing.deviation / ringing_gain(ringing);
  const double r = ringing.radius;
  const auto side = [r](double away) { return 1.0 - 2.0 * r * std::cos(away) + r * r; };
  Series out(samples - 1);
  for (std::size_t k = 1; k < samples; ++k) {
    const double omega = angle(k, samples);
    out[k - 1] = power / (side(omega - ringing.omega) * side(omega + ringing.omega));
  }
  return out;
}

Series BaseNoise::simulate(RandomStream& random, std::size_t samples) const {
  Series out(samples);
  double position = 0.0;
  for (double& x : out) {
    x = position + white * random.normal();
    position += walk * random.normal();
  }
  for (const Markov& part : markov) add(out, hidden::simulate(part, random, samples));
  for (const Ringing& part : ringing) add(out, hidden::simulate(part, random, samples));
  return out;
}

std::vector<Series> BaseNoise::parts(std::size_t samples) const {
  std::vector<Series> out;
  if (white > 0.0) out.emplace_back(samples - 1, white * white);
  if (walk > 0.0) out.push_back(walk_spectrum(walk, samples));
  if (!markov.empty()) {
    Series sum(samples - 1, 0.0);
    for (const Markov& part : markov) add(sum, hidden::spectrum(part, samples));
    out.push_back(std::move(sum));
  }
  for (const Ringing& part : ringing) out.push_back(hidden::spectrum(part, samples));
  return out;
}

Series BaseNoise::spectrum(std::size_t samples) const {
  Series out(samples - 1, 0.0);
  for (const Series& part : parts(samples)) add(out, part);
  return out;
}

// A Markov noise of variance v and time τ has the two-sided spectrum 2vτ/(1 + (2πfτ)²). With
// v = c·τ^(a-1), a = -slope, summed over ln τ, one every ln 2, that is
// (2c/ln 2)·∫ τ^(a-1)/(1 + (2πfτ)²) dτ = (2c/ln 2)·(2πf)^(-a)·(π/2)/sin(πa/2).
std::vector<Markov> octaves_of_power_law(double slope, double level, std::size_t samples) {
  const double a = -slope;
  const double scale = std::numbers::ln2 / std::numbers::pi * std::sin(0.5 * std::numbers::pi * a) *
                       std::pow(2.0 * std::numbers::pi, a);
  std::vector<Markov> out;
  for (double tau = 1.0; tau <= 8.0 * static_cast<double>(samples); tau *= 2.0) {
    out.push_back({level * std::sqrt(scale * std::pow(tau, a - 1.0)), tau});
  }
  return out;
}

std::vector<Markov> octaves_of_flicker(double level, std::size_t samples) {
  return octaves_of_power_law(-1.0, level, samples);
}

BaseNoise draw_base(Base base, std::size_t samples, RandomStream& random) {
  BaseNoise out;
  const double level = log_uniform(random, 3e-4, 3e-3);
  const double walk = level * log_uniform(random, 1e-3, 1e-2);
  switch (base) {
    case Base::kWhite:
      out.white = level;
      out.model = "WN";
      break;
    case Base::kWhiteWalk:
      out.white = level;
      out.walk = walk;
      out.model = "WN + RW";
      break;
    case Base::kMarkovWalk:
      out.walk = walk;
      out.markov = {{level, uniform(random, 5.0, 20.0)}};
      out.model = "AR1 + RW";
      break;
    case Base::kMarkov:
      out.white = level;
      out.walk = walk;
      out.markov = {{level * uniform(random, 0.3, 1.0), log_uniform(random, 10.0, 100.0)}};
      out.model = "WN + AR1 + RW";
      break;
    case Base::kFlicker:
      out.white = level;
      out.walk = 0.3 * walk;
      out.markov = octaves_of_flicker(level * uniform(random, 0.03, 0.1), samples);
      out.model = "WN + FN + RW";
      break;
  }
  return out;
}

}  // namespace imunoise::hidden
