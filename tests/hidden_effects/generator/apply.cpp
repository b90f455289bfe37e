#include "tests/hidden_effects/generator/apply.h"

#include <algorithm>
#include <cmath>
#include <numeric>

#include "tests/hidden_effects/generator/cosine.h"
#include "tests/hidden_effects/generator/oracle.h"
#include "tests/hidden_effects/generator/white_walk.h"

namespace imunoise::hidden {

double add_shapes(Scene& scene, const std::vector<Series>& shapes, double delta) {
  const double factor = delta / mean_strength(shapes, scene.spectrum);
  for (std::size_t r = 0; r < scene.replicates(); ++r) {
    Series& gyro = scene.recordings[r][kSubject];
    for (std::size_t t = 0; t < gyro.size(); ++t) gyro[t] += factor * shapes[r][t];
  }
  return factor;
}

Injection of_mean(double delta, std::vector<TrueParameter> parameters) {
  return {delta, delta, std::move(parameters)};
}

Injection of_spectrum(const Scene& scene, const Series& after) {
  const double count = static_cast<double>(scene.replicates());
  const Series nearest = nearest_sum(after, scene.base.parts(scene.samples()));
  return {strength(divergence(nearest, after), count),
          strength(divergence(scene.spectrum, after), count),
          {}};
}

namespace {

// The nearest of the base's noises, whose Markov noises may change their correlation times.
Series nearest_base(const Scene& scene, const Series& after) {
  const auto of = [&](double log_factor) {
    BaseNoise base = scene.base;
    for (Markov& one : base.markov) one.tau *= std::exp(log_factor);
    return nearest_sum(after, base.parts(scene.samples()));
  };
  const auto distance = [&](double log_factor) { return divergence(of(log_factor), after); };
  const double golden = 0.5 * (std::sqrt(5.0) - 1.0);
  double low = -3.0;
  double high = 3.0;
  while (!scene.base.markov.empty() && high - low > 1e-3) {
    const double part = golden * (high - low);
    (distance(high - part) < distance(low + part) ? high : low) =
        distance(high - part) < distance(low + part) ? low + part : high - part;
  }
  return of(scene.base.markov.empty() ? 0.0 : 0.5 * (low + high));
}

}  // namespace

Injection of_data(const Scene& scene, const Series& after) {
  Injection out = of_spectrum(scene, after);
  const Series nearest = nearest_base(scene, after);
  out.gained = 0.0;
  for (const Recording& recording : scene.recordings)
    *out.gained += likelihood_ratio(cosine_coefficients(recording[kSubject]), nearest, after);
  return out;
}

// The informed δ is cheap and near: from there, secants of ln δ over ln size.
double solve_size(const Scene& scene, double delta, double low, double high,
                  const std::function<Series(double size)>& after) {
  const double count = static_cast<double>(scene.replicates());
  double size = solve_strength(delta, low, high, [&](double x) {
    return strength(divergence(scene.spectrum, after(x)), count);
  });
  double slope = 1.0;
  double last_size = 0.0;
  double last_excess = 0.0;
  for (int step = 0; step < 20; ++step) {
    const double excess = std::log(of_spectrum(scene, after(size)).delta / delta);
    if (std::abs(excess) < 1e-4 || size == last_size) break;  // there, or at the end of the range
    if (step > 0) slope = (excess - last_excess) / std::log(size / last_size);
    last_size = size;
    last_excess = excess;
    size = std::min(size * std::exp(-excess / std::max(slope, 0.2)), high);
  }
  return size;
}

Injection add_noise(Scene& scene, double delta,
                    const std::function<BaseNoise(double deviation)>& shape, double& deviation) {
  const Series unit = shape(1.0).spectrum(scene.samples());
  const auto after = [&](double size) {
    Series out = scene.spectrum;
    for (std::size_t k = 0; k < out.size(); ++k) out[k] += size * size * unit[k];
    return out;
  };
  deviation = solve_size(scene, delta, 1e-9 * scene.floor(), 1e3 * scene.floor(), after);
  for (Recording& recording : scene.recordings) {
    const Series noise = shape(deviation).simulate(scene.random, scene.samples());
    Series& gyro = recording[kSubject];
    for (std::size_t t = 0; t < gyro.size(); ++t) gyro[t] += noise[t];
  }
  return of_data(scene, after(deviation));
}

namespace {

// Nats by which samples in a walk are likelier with the white noise that came to them than as
// noise of one power, which for each replicate the others tell: so a model is held out, too.
double gained_by_power(const Scene& scene, const std::vector<Series>& more) {
  const WhiteWalk noise{scene.base.white, scene.base.walk};
  std::vector<double> squares;
  double out = 0.0;
  for (std::size_t r = 0; r < scene.replicates(); ++r) {
    const Series& gyro = scene.recordings[r][kSubject];
    squares.push_back(0.0);
    for (const double z : innovations(gyro, noise)) squares.back() += z * z;
    out += log_likelihood(gyro, noise, more[r]) - log_likelihood(gyro, noise) - 0.5 * squares[r];
  }
  const double all = std::accumulate(squares.begin(), squares.end(), 0.0);
  const auto samples = static_cast<double>(scene.samples());
  for (const double own : squares) {
    const double level = (all - own) / (samples * static_cast<double>(squares.size() - 1));
    out += 0.5 * (samples * std::log(level) + own / level);
  }
  return out;
}

}  // namespace

Injection add_power(Scene& scene, const std::vector<Series>& courses, double delta) {
  const auto after = [&](double growth) {
    Series out;
    for (const Series& course : courses) {
      for (const double x : course) out.push_back(1.0 + growth * x);
    }
    return out;
  };
  const double growth =
      solve_strength(delta, 1e-6, 1e3, [&](double g) { return swing_strength(after(g)); });
  std::vector<Series> more = courses;
  for (std::size_t r = 0; r < scene.replicates(); ++r) {
    Series& gyro = scene.recordings[r][kSubject];
    for (std::size_t t = 0; t < gyro.size(); ++t) {
      more[r][t] *= growth * scene.floor() * scene.floor();
      gyro[t] += std::sqrt(more[r][t]) * scene.random.normal();
    }
  }
  const double put = swing_strength(after(growth));
  return {put, put, {{"growth", growth, "1"}}, gained_by_power(scene, more)};
}

}  // namespace imunoise::hidden
