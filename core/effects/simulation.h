#pragma once

#include <cstdint>
#include <functional>
#include <string>
#include <vector>

#include "core/effect/full_model.h"
#include "core/effect/subject.h"
#include "core/support/result.h"

namespace imunoise {

/// Another channel that the effects of a simulated one follow.
struct SimulatedWitness {
  std::string name;
  /// Its samples in a replicate, counted from 0, SI: as many as the simulation has.
  std::function<std::vector<double>(std::uint32_t replicate)> samples;
};

struct SimulationSize {
  std::size_t samples = 0;  ///< of each replicate
  Hertz rate;
  std::uint32_t replicates = 1;
  /// Number of the random stream of the first replicate: simulations of one seed whose streams do
  /// not overlap are independent.
  std::uint32_t first_stream = 0;
};

/// One replicate.
struct SimulatedSamples {
  std::vector<double> channel;                 ///< SI
  std::vector<std::vector<double>> witnesses;  ///< SI, in their order
};

/// Draws replicates of noise with effects of given size: the noise of simulate(Model), then
/// simulate_effects(). Thread-safe where the witnesses are.
class Simulation {
 public:
  /// Error: a value that is left open (the sizes of effects included), an effect that recordings of
  /// this size cannot show, or one that follows a channel that is not simulated.
  static Result<Simulation> make(FullModel model, SimulationSize size, std::uint64_t seed,
                                 std::vector<SimulatedWitness> witnesses = {});

  SimulatedSamples replicate(std::uint32_t number) const;

 private:
  Simulation() = default;

  FullModel model_;
  SimulationSize size_;
  std::uint64_t seed_ = 0;
  std::vector<SimulatedWitness> witnesses_;
  Subject empty_;  // replicates of the right length, without samples of witnesses
};

}  // namespace imunoise
