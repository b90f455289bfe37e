#include "tests/hidden_effects/generator/two_level_oracle.h"

#include <algorithm>
#include <cmath>

#include "tests/hidden_effects/generator/draw.h"

namespace imunoise::hidden {
namespace {

struct Course {
  double walk = 0.0;   // as its filter knows it
  double level = 0.0;  // now
};

// As many, each as often as its weight says, to the nearest whole number (systematic resampling).
std::vector<Course> drawn(const std::vector<Course>& from, const Series& weights, double part) {
  std::vector<Course> out;
  const double count = static_cast<double>(from.size());
  double sum = 0.0;
  for (std::size_t i = 0; i < from.size(); ++i) {
    sum += weights[i];
    while (out.size() < from.size() && static_cast<double>(out.size()) + part < sum * count)
      out.push_back(from[i]);
  }
  out.resize(from.size(), from.back());
  return out;
}

}  // namespace

double log_likelihood(const Series& x, const WhiteWalk& noise, const TwoLevelLaw& law,
                      RandomStream& random, std::size_t particles) {
  WalkFilter known(noise);
  std::vector<Course> courses(particles);
  for (Course& one : courses) one.level = 0.5 * law.height * sign(random);
  Series weights(particles, 1.0 / static_cast<double>(particles));
  const double jumps = 1.0 / law.dwell;
  double out = 0.0;
  for (std::size_t t = 0; t < x.size(); ++t) {
    const double variance = known.expected();
    const double gain = known.next();
    double total = 0.0;
    for (std::size_t i = 0; i < particles; ++i) {
      Course& one = courses[i];
      // By what comes next it is decided whether it jumps.
      const double stays = x[t] - one.level - one.walk;
      const double goes = x[t] + one.level - one.walk;
      const double if_stays =
          (t == 0 ? 1.0 : 1.0 - jumps) * std::exp(-0.5 * stays * stays / variance);
      const double if_goes = (t == 0 ? 0.0 : jumps) * std::exp(-0.5 * goes * goes / variance);
      const double either = std::max(if_stays + if_goes, 1e-300);
      if (uniform(random, 0.0, 1.0) * either < if_goes) one.level = -one.level;
      one.walk += gain * (x[t] - one.level - one.walk);
      weights[i] *= either;
      total += weights[i];
    }
    out += std::log(total) - 0.5 * std::log(variance);
    double squares = 0.0;
    for (double& weight : weights) {
      weight /= total;
      squares += weight * weight;
    }
    if (2.0 < squares * static_cast<double>(particles)) {
      courses = drawn(courses, weights, uniform(random, 0.0, 1.0));
      std::fill(weights.begin(), weights.end(), 1.0 / static_cast<double>(particles));
    }
  }
  return out;
}

}  // namespace imunoise::hidden
