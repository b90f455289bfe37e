#include "core/process/sampler.h"

#include <cmath>
#include <utility>

#include "core/process/flicker_recursion.h"
#include "core/process/recursions.h"

namespace imunoise {
namespace {

struct White {
  double sigma;
  double next(RandomStream& rng) const { return sigma * rng.normal(); }
};

struct Walk {
  double gamma;
  double level = 0.0;
  double next(RandomStream& rng) { return level += gamma * rng.normal(); }
};

struct Ramp {
  double omega;
  double index = 0.0;
  double next(RandomStream& /*rng*/) { return omega * index++; }
};

using Recursion = std::variant<White, Walk, Ramp, MarkovRecursion, ResonanceRecursion,
                               TapsRecursion, FlickerRecursion>;

// How each process goes on; one that is missing here does not compile.
struct Begin {
  RandomStream& rng;

  Recursion operator()(const WhiteNoise& p) const { return White{std::sqrt(p.sigma2)}; }
  Recursion operator()(const QuantisationNoise& p) const {
    return TapsRecursion({1.0, -1.0}, std::sqrt(p.q2), rng);
  }
  Recursion operator()(const RandomWalk& p) const { return Walk{std::sqrt(p.gamma2)}; }
  Recursion operator()(const Drift& p) const { return Ramp{std::sqrt(p.omega2)}; }
  Recursion operator()(const Ar1& p) const { return MarkovRecursion(p, rng); }
  Recursion operator()(const GaussMarkov& p) const { return MarkovRecursion(p.discrete(), rng); }
  Recursion operator()(const Resonance& p) const { return ResonanceRecursion(p, rng); }
  Recursion operator()(const MovingAverage& p) const {
    std::vector<double> taps = {1.0};
    taps.insert(taps.end(), p.theta.begin(), p.theta.end());
    return TapsRecursion(std::move(taps), std::sqrt(p.sigma2), rng);
  }
  Recursion operator()(const MovingAverageFilter& p) const {
    return TapsRecursion(boxcar_taps(p.length), std::sqrt(p.sigma2), rng);
  }
  Recursion operator()(const BartlettFilter& p) const {
    return TapsRecursion(bartlett_taps(p.length), std::sqrt(p.sigma2), rng);
  }
  Recursion operator()(const Flicker& p) const { return FlickerRecursion(p, rng); }
};

}  // namespace

class Sampler::State {
 public:
  State(const Process& process, RandomStream rng)
      : rng_(std::move(rng)), recursion_(std::visit(Begin{rng_}, process)) {}
  double next() {
    return std::visit([&](auto& recursion) { return recursion.next(rng_); }, recursion_);
  }

 private:
  RandomStream rng_;
  Recursion recursion_;
};

Sampler::Sampler(const Process& process, RandomStream rng)
    : state_(std::make_unique<State>(process, std::move(rng))) {}
Sampler::Sampler(Sampler&&) noexcept = default;
Sampler& Sampler::operator=(Sampler&&) noexcept = default;
Sampler::~Sampler() = default;

double Sampler::next() { return state_->next(); }

}  // namespace imunoise
