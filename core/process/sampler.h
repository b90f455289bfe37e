#pragma once

// Any process, sample by sample.

#include <memory>

#include "core/process/process.h"

namespace imunoise {

/// One realisation of a process, as long as it is asked for, in bounded memory: what add_samples()
/// gives from the same stream, sample by sample. Only flicker noise differs, which add_samples()
/// draws for a length that is known (FlickerRecursion). Movable. One thread at a time.
class Sampler {
 public:
  Sampler(const Process& process, RandomStream rng);
  Sampler(Sampler&&) noexcept;
  Sampler& operator=(Sampler&&) noexcept;
  ~Sampler();

  double next();

 private:
  class State;
  template <NoiseProcess P>
  class StateOf;
  std::unique_ptr<State> state_;
};

}  // namespace imunoise
