// Effects of the second order: another noise beside the base, or a filter over it.

#include <cmath>
#include <numbers>

#include "tests/hidden_effects/generator/apply.h"
#include "tests/hidden_effects/generator/draw.h"

namespace imunoise::hidden {
namespace {

BaseNoise of_white(double deviation) {
  BaseNoise out;
  out.white = deviation;
  return out;
}

BaseNoise of_walk(double deviation) {
  BaseNoise out;
  out.walk = deviation;
  return out;
}

BaseNoise of_markov(Markov markov) {
  BaseNoise out;
  out.markov = {markov};
  return out;
}

Injection hide_white(Scene& scene, double delta) {
  double deviation = 0.0;
  Injection out = add_noise(scene, delta, of_white, deviation);
  out.parameters = {{"sigma2", deviation * deviation, "(rad/s)^2"}};
  return out;
}

Injection hide_walk(Scene& scene, double delta) {
  double deviation = 0.0;
  Injection out = add_noise(scene, delta, of_walk, deviation);
  out.parameters = {{"gamma2", deviation * deviation, "(rad/s)^2"}};
  return out;
}

Injection hide_markov(Scene& scene, double delta, double tau) {
  double deviation = 0.0;
  Injection out = add_noise(
      scene, delta,
      [tau](double size) {
        return of_markov({size, tau});
      },
      deviation);
  out.parameters = {{"tau_s", tau / scene.rate_hz, "s"}};
  return out;
}

Injection hide_short_markov(Scene& scene, double delta) {
  return hide_markov(scene, delta, log_uniform(scene.random, 4.0, 12.0));
}

// 50 to 200 correlation times in a replicate.
Injection hide_long_markov(Scene& scene, double delta) {
  const double part = log_uniform(scene.random, 0.005, 0.02);
  return hide_markov(scene, delta, part * static_cast<double>(scene.samples()));
}

Injection hide_flicker(Scene& scene, double delta) {
  const std::size_t samples = scene.samples();
  double level = 0.0;
  Injection out = add_noise(
      scene, delta,
      [samples](double size) {
        BaseNoise noise;
        noise.markov = octaves_of_flicker(size, samples);
        return noise;
      },
      level);
  // Two-sided level²/f, f in cycles per sample, against B²/(2πf).
  out.parameters = {{"b2", 2.0 * std::numbers::pi * level * level, "(rad/s)^2"}};
  return out;
}

Injection hide_resonance(Scene& scene, double delta) {
  const double radius = uniform(scene.random, 0.90, 0.98);
  const double omega = uniform(scene.random, 0.3, 2.5);
  double deviation = 0.0;
  Injection out = add_noise(
      scene, delta,
      [&](double size) {
        BaseNoise noise;
        noise.ringing = {{size, radius, omega}};
        return noise;
      },
      deviation);
  out.parameters = {{"frequency_hz", omega * scene.rate_hz / (2.0 * std::numbers::pi), "Hz"}};
  return out;
}

// y_t = p y_{t-1} + (1-p) x_t over everything that the sensor makes.
Injection hide_low_pass(Scene& scene, double delta) {
  const auto after = [&](double pole) {
    Series out = scene.spectrum;
    for (std::size_t k = 0; k < out.size(); ++k) {
      const double omega =
          std::numbers::pi * static_cast<double>(k + 1) / static_cast<double>(scene.samples());
      out[k] *= (1.0 - pole) * (1.0 - pole) / (1.0 - 2.0 * pole * std::cos(omega) + pole * pole);
    }
    return out;
  };
  const double pole = solve_size(scene, delta, 1e-6, 0.9, after);
  for (Recording& recording : scene.recordings) {
    Series& gyro = recording[kSubject];
    double state = gyro.front();
    for (double& x : gyro) x = state += (1.0 - pole) * (x - state);
  }
  Injection out = of_data(scene, after(pole));
  out.parameters = {{"tau_s", -1.0 / (std::log(pole) * scene.rate_hz), "s"}};
  return out;
}

// The device gives differences of an angle that it counts in whole steps.
Injection hide_angle_rounding(Scene& scene, double delta) {
  const auto after = [&](double error) {
    Series out = scene.spectrum;
    for (std::size_t k = 0; k < out.size(); ++k) {
      const double s = std::sin(0.5 * std::numbers::pi * static_cast<double>(k + 1) /
                                static_cast<double>(scene.samples()));
      out[k] += 4.0 * error * error * s * s;
    }
    return out;
  };
  const double error = solve_size(scene, delta, 1e-6 * scene.floor(), scene.floor(), after);
  const double step = std::sqrt(12.0) * error;
  for (Recording& recording : scene.recordings) {
    double angle = step * uniform(scene.random, 0.0, 1.0);
    double told = std::round(angle / step);
    for (double& x : recording[kSubject]) {
      angle += x;
      const double now = std::round(angle / step);
      x = step * (now - told);
      told = now;
    }
  }
  Injection out = of_data(scene, after(error));
  out.parameters = {{"q2", error * error, "(rad/s)^2"}, {"step", step, "rad/s"}};
  return out;
}

}  // namespace

std::vector<HiddenEffect> noise_effects() {
  const auto effect = [](const char* id, const char* variant, Family family, Base base, auto hide) {
    HiddenEffect out;
    out.id = id;
    out.variant = variant;
    out.family = family;
    out.base = base;
    out.hide = hide;
    return out;
  };
  return {
      effect("quantisation", "angle", Family::kShort, Base::kWhiteWalk, hide_angle_rounding),
      effect("white_noise", "", Family::kShort, Base::kMarkovWalk, hide_white),
      effect("random_walk", "", Family::kSlow, Base::kWhite, hide_walk),
      effect("gauss_markov", "short", Family::kShort, Base::kWhiteWalk, hide_short_markov),
      effect("gauss_markov", "long", Family::kSlow, Base::kWhiteWalk, hide_long_markov),
      effect("flicker", "", Family::kSlow, Base::kWhiteWalk, hide_flicker),
      effect("low_pass", "", Family::kShort, Base::kWhiteWalk, hide_low_pass),
      effect("resonance", "", Family::kShort, Base::kWhiteWalk, hide_resonance),
      effect("resonance", "markov", Family::kShort, Base::kMarkov, hide_resonance),
  };
}

}  // namespace imunoise::hidden
