#include "tests/hidden_effects/generator/white_walk.h"

#include <cmath>
#include <functional>

namespace imunoise::hidden {
namespace {

constexpr double kAnywhere = 1e8;  // variance of the walk's start, in units of the white noise's

void filter(const Series& x, const WhiteWalk& noise, const Series& more,
            const std::function<void(double innovation, double variance)>& visit) {
  WalkFilter known(noise);
  double walk = 0.0;
  for (std::size_t t = 0; t < x.size(); ++t) {
    const double own = more.empty() ? 0.0 : more[t];
    const double innovation = x[t] - walk;
    visit(innovation, known.expected(own));
    walk += known.next(own) * innovation;
  }
}

}  // namespace

WalkFilter::WalkFilter(const WhiteWalk& noise)
    : white_(noise.white * noise.white),
      walk_(noise.walk * noise.walk),
      variance_(kAnywhere * white_) {}

double WalkFilter::next(double more) {
  const double gain = variance_ / expected(more);
  variance_ = variance_ * (1.0 - gain) + walk_;
  return gain;
}

Series innovations(const Series& x, const WhiteWalk& noise) {
  Series out;
  filter(x, noise, {}, [&](double innovation, double variance) {
    out.push_back(innovation / std::sqrt(variance));
  });
  return out;
}

double log_likelihood(const Series& x, const WhiteWalk& noise, const Series& more) {
  double out = 0.0;
  filter(x, noise, more, [&](double innovation, double variance) {
    out -= 0.5 * (std::log(variance) + innovation * innovation / variance);
  });
  return out;
}

}  // namespace imunoise::hidden
