#pragma once

#include "core/support/random.h"
#include "drivers/emulator/measurement/sample_source.h"

namespace imunoise::emulator {

/// Constants with white Gaussian noise. The same seed gives the same numbers.
class GaussianSource final : public SampleSource {
 public:
  GaussianSource(const Measurement& mean, const Measurement& standard_deviation,
                 std::uint64_t seed);

  Measurement measure(double time) override;

 private:
  Measurement mean_;
  Measurement standard_deviation_;
  RandomStream random_;
};

}  // namespace imunoise::emulator
