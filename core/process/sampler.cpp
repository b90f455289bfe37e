#include "core/process/sampler.h"

#include <utility>

namespace imunoise {

class Sampler::State {
 public:
  virtual ~State() = default;
  virtual double next() = 0;
};

template <NoiseProcess P>
class Sampler::StateOf final : public State {
 public:
  StateOf(const P& process, RandomStream rng)
      : rng_(std::move(rng)), recursion_(process.recursion(rng_)) {}
  double next() override { return recursion_.next(rng_); }

 private:
  RandomStream rng_;
  decltype(std::declval<const P&>().recursion(std::declval<RandomStream&>())) recursion_;
};

Sampler::Sampler(const Process& process, RandomStream rng)
    : state_(std::visit(
          [&](const auto& p) -> std::unique_ptr<State> {
            return std::make_unique<StateOf<std::decay_t<decltype(p)>>>(p, std::move(rng));
          },
          process)) {}
Sampler::Sampler(Sampler&&) noexcept = default;
Sampler& Sampler::operator=(Sampler&&) noexcept = default;
Sampler::~Sampler() = default;

double Sampler::next() { return state_->next(); }

}  // namespace imunoise
