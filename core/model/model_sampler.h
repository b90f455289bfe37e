#pragma once

#include <cstdint>
#include <vector>

#include "core/model/model.h"
#include "core/process/sampler.h"

namespace imunoise {

/// One realisation of a model, sample by sample, as long as it is asked for, in bounded memory: the
/// numbers of simulate() with the same seed and replicate, except for flicker noise (Sampler).
/// Movable. One thread at a time.
class ModelSampler {
 public:
  ModelSampler(const Model& model, std::uint64_t seed, std::uint32_t replicate);
  double next();

 private:
  std::vector<Sampler> terms_;
};

}  // namespace imunoise
