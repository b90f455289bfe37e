#include "core/model/model_sampler.h"

namespace imunoise {

ModelSampler::ModelSampler(const Model& model, std::uint64_t seed, std::uint32_t replicate) {
  for (std::uint32_t i = 0; i < model.terms.size(); ++i) {
    terms_.emplace_back(model.terms[i].process, RandomStream(seed, {replicate, i}));
  }
}

double ModelSampler::next() {
  double out = 0.0;
  for (Sampler& term : terms_) out += term.next();
  return out;
}

}  // namespace imunoise
